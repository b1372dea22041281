#include "simulators/feed/recording.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace recald::simulators {
namespace {

constexpr std::chrono::days kRunIn{31};

struct Sum {
  UtilityPower power;
  WeatherMean weather{};
  double wind_east = 0.0;
  double wind_north = 0.0;

  void add(const Outdoors& outdoors, const UtilityPower& now, double share) {
    power.electricity_kW += share * now.electricity_kW;
    power.cooling_kW += share * now.cooling_kW;
    power.heat_kW += share * now.heat_kW;
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

Result<Recording> record(Building& building, const Period& period, std::uint64_t seed) {
  assert(period.years >= 1 && kInterval % building.step() == std::chrono::seconds{0});
  const Drawings& drawings = building.truth().drawings;
  const auto calendar = TRY(metering::LocalCalendar::open(drawings.time_zone));
  using std::chrono::January;
  const std::chrono::year first{period.start_year};
  const std::chrono::year after{period.start_year + period.years};
  const metering::Instant begin = calendar.month_span(first / January).begin;
  const metering::Instant end = calendar.month_span(after / January).begin;

  const std::chrono::seconds step = building.step();
  const auto steps = static_cast<int>(kInterval / step);
  WeatherGenerator weather(climate_of(drawings.climate, drawings.place), begin - kRunIn,
                           stream_of(seed, Stream::weather), step);
  for (metering::Instant now = begin - kRunIn; now < begin; now += step) {
    building.advance(weather.advance(), now, calendar.local_time(now));
  }
  Recording recording{begin, {}, {}};
  const auto slots = static_cast<std::size_t>((end - begin) / kInterval);
  recording.weather.reserve(slots);
  recording.power.reserve(slots);
  for (metering::Instant now = begin; now < end; now += kInterval) {
    Sum sum;
    const metering::LocalTime local = calendar.local_time(now);
    for (int i = 0; i < steps; ++i) {
      const Outdoors outdoors = weather.advance();
      const auto minutes = std::chrono::duration_cast<std::chrono::minutes>(i * step);
      const int minute = local.minute_of_day + static_cast<int>(minutes.count());
      sum.add(outdoors, building.advance(outdoors, now + i * step, {local.date, minute}),
              1.0 / steps);
    }
    recording.weather.push_back(sum.weather_mean());
    recording.power.push_back(sum.power);
  }
  return recording;
}

std::vector<double> metered_kW(const Recording& recording, Utility utility,
                               const HiddenEffects& effects,
                               const metering::LocalCalendar& calendar) {
  std::vector<double> shown_kW;
  shown_kW.reserve(recording.power.size());
  for (const UtilityPower& power : recording.power) shown_kW.push_back(power[utility]);
  for (const auto& effect : effects) {
    effect->distort({utility, recording.begin, calendar, shown_kW});
  }
  return shown_kW;
}

}  // namespace recald::simulators
