#include "daemon/site/model/hourly_run.hpp"

#include <algorithm>
#include <utility>

#include "core/model/hourly/hourly.hpp"

namespace recald::daemon {

Eigen::ArrayXXd modelled_kW(const model::Building& building,
                            std::shared_ptr<const model::Drivers> drivers,
                            std::span<const model::MeterMap> maps) {
  model::hourly::Hourly hourly{std::move(drivers)};
  Eigen::ArrayXXd power_kW(hourly.step_count(), static_cast<Eigen::Index>(maps.size()));
  hourly.run(building, {}, maps, power_kW);
  return power_kW;
}

weather::WeatherSeries continued(const weather::WeatherSeries& series, metering::Instant from,
                                 metering::Instant known_until, metering::Instant until) {
  constexpr std::size_t kWeek = 7 * 24;
  using metering::Instant;
  const Instant begin =
      std::max<Instant>(series.begin, std::chrono::floor<std::chrono::hours>(from));
  const Instant end =
      std::min<Instant>(series.end(), std::chrono::ceil<std::chrono::hours>(known_until));
  weather::WeatherSeries longer{.begin = begin, .hours = {}};
  if (end <= begin) return longer;
  const auto first = series.hours.begin() + (begin - series.begin) / std::chrono::hours{1};
  longer.hours.assign(first, first + (end - begin) / std::chrono::hours{1});
  if (longer.hours.size() < kWeek) return longer;
  while (longer.end() < until) longer.hours.push_back(longer.hours[longer.hours.size() - kWeek]);
  return longer;
}

}  // namespace recald::daemon
