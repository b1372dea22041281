#include "simulators/feed/recording.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace recald::simulators {
namespace {

constexpr int kStepsPerInterval = static_cast<int>(kInterval / kStep);
constexpr std::chrono::days kRunIn{31};

struct Sum {
  UtilityPower power;
  WeatherMean weather{};
  double wind_east = 0.0;
  double wind_north = 0.0;

  void add(const Outdoors& outdoors, const UtilityPower& now) {
    constexpr double share = 1.0 / kStepsPerInterval;
    power.electricity_kW += share * now.electricity_kW;
    power.chilled_water_kW += share * now.chilled_water_kW;
    power.steam_kW += share * now.steam_kW;
    weather.dry_bulb_C += share * outdoors.air.temperature_C;
    weather.relative_humidity += share * outdoors.relative_humidity;
    weather.wind_speed_m_s += share * outdoors.wind_speed_m_s;
    weather.global_horizontal_W_m2 += share * outdoors.global_horizontal_W_m2;
    const double from = outdoors.wind_from_deg * std::numbers::pi / 180.0;
    wind_east += outdoors.wind_speed_m_s * std::sin(from);
    wind_north += outdoors.wind_speed_m_s * std::cos(from);
  }

  [[nodiscard]] WeatherMean weather_mean() const {
    WeatherMean mean = weather;
    const double from_deg = std::atan2(wind_east, wind_north) * 180.0 / std::numbers::pi;
    mean.wind_from_deg = from_deg < 0.0 ? from_deg + 360.0 : from_deg;
    return mean;
  }
};

}  // namespace

Result<Recording> record(const Truth& truth, const Period& period, std::uint64_t seed) {
  assert(period.years >= 1);
  const auto calendar = metering::LocalCalendar::open(drawings::time_zone);
  if (!calendar) return tl::unexpected(calendar.error());
  using std::chrono::January;
  const std::chrono::year first{period.start_year};
  const std::chrono::year after{period.start_year + period.years};
  const metering::Instant begin = calendar->month_span(first / January).begin;
  const metering::Instant end = calendar->month_span(after / January).begin;

  WeatherGenerator weather(hot_humid_climate(drawings::place), begin - kRunIn,
                           stream_of(seed, Stream::weather));
  Building building(truth, seed);
  for (metering::Instant now = begin - kRunIn; now < begin; now += kStep) {
    building.advance(weather.advance(), calendar->local_time(now));
  }
  Recording recording{begin, {}, {}};
  const auto slots = static_cast<std::size_t>((end - begin) / kInterval);
  recording.weather.reserve(slots);
  recording.power.reserve(slots);
  for (metering::Instant now = begin; now < end; now += kInterval) {
    Sum sum;
    const metering::LocalTime local = calendar->local_time(now);
    for (int step = 0; step < kStepsPerInterval; ++step) {
      const Outdoors outdoors = weather.advance();
      const int minute = local.minute_of_day + step * static_cast<int>(kStep_s / 60.0);
      sum.add(outdoors, building.advance(outdoors, {local.date, minute}));
    }
    recording.weather.push_back(sum.weather_mean());
    recording.power.push_back(sum.power);
  }
  return recording;
}

}  // namespace recald::simulators
