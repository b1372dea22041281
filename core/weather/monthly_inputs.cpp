#include "core/weather/monthly_inputs.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace recald::weather {
namespace {

constexpr std::array<const char*, 5> kNames = {"dry_bulb_C", "rel_humidity_pct", "wind_speed_m_s",
                                               "wind_dir_sin", "wind_dir_cos"};
using Means = Eigen::Array<double, 5, 1>;

Means month_means(const WeatherSeries& weather, const metering::TimeSpan& span) {
  Means sum = Means::Zero();
  Means count = Means::Zero();
  const auto add = [&](Eigen::Index i, double value) {
    if (!std::isfinite(value)) return;
    sum[i] += value;
    count[i] += 1.0;
  };
  for (Instant t = std::chrono::ceil<std::chrono::hours>(span.begin); t < span.end;
       t += std::chrono::hours{1}) {
    const WeatherHour* hour = weather.find(t);
    if (hour == nullptr) continue;
    const double direction = hour->wind_dir_deg * std::numbers::pi / 180.0;
    add(0, hour->dry_bulb_C);
    add(1, hour->rel_humidity_pct);
    add(2, hour->wind_speed_m_s);
    add(3, hour->wind_speed_m_s * std::sin(direction));
    add(4, hour->wind_speed_m_s * std::cos(direction));
  }
  Means mean = sum / count;  // NaN where nothing was counted
  const double length = std::hypot(mean[3], mean[4]);
  if (length > 0.0) mean.tail<2>() /= length;
  return mean;
}

bool is_usable(const Eigen::Ref<const Eigen::ArrayXd>& column) {
  return column.isFinite().all() && column.maxCoeff() > column.minCoeff();
}

}  // namespace

MonthlyInputs monthly_inputs(const WeatherSeries& weather, const metering::LocalCalendar& calendar,
                             const std::vector<metering::Month>& months) {
  const auto n = static_cast<Eigen::Index>(months.size());
  Eigen::ArrayXXd all(n, static_cast<Eigen::Index>(kNames.size()));
  for (Eigen::Index i = 0; i < n; ++i) {
    const metering::TimeSpan span = calendar.month_span(months[static_cast<std::size_t>(i)]);
    all.row(i) = month_means(weather, span).transpose();
  }
  MonthlyInputs inputs;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index column = 0; column < all.cols(); ++column) {
    if (!is_usable(all.col(column))) continue;
    kept.push_back(column);
    inputs.names.emplace_back(kNames[static_cast<std::size_t>(column)]);
  }
  inputs.values.resize(n, static_cast<Eigen::Index>(kept.size()));
  for (std::size_t k = 0; k < kept.size(); ++k) {
    inputs.values.col(static_cast<Eigen::Index>(k)) = all.col(kept[k]).matrix();
  }
  return inputs;
}

}  // namespace recald::weather
