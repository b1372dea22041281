/// Simulates weather and building over whole local years and keeps 15-minute means.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simulators/building/building.hpp"
#include "simulators/climate/weather.hpp"

namespace recald::simulators {

/// First and last year are local calendar years in the building's time zone.
struct Period {
  int start_year = 2021;
  int years = 3;
};

/// What a perfect weather station would have reported for one interval.
struct WeatherMean {
  double dry_bulb_C;
  double relative_humidity;  ///< 0…1
  double wind_speed_m_s;
  double wind_from_deg;  ///< Of the mean wind vector.
  double global_horizontal_W_m2;
};

/// Gapless, `kInterval` apart, start-stamped from `begin`.
struct Recording {
  metering::Instant begin;
  std::vector<WeatherMean> weather;
  std::vector<UtilityPower> power;

  [[nodiscard]] metering::Instant start_of(std::size_t slot) const {
    return begin + static_cast<std::int64_t>(slot) * kInterval;
  }
};

/// Simulates the building through the period, after a month in which walls and rooms settle. The
/// weather follows the drawings' climate and the `seed`.
/// @return the recording, or not_found if the system has no zone files.
/// @pre period.years >= 1, the period lies in 1971…2037, the building's step divides `kInterval`
[[nodiscard]] Result<Recording> record(Building& building, const Period& period,
                                       std::uint64_t seed);

/// What the meters would show without noise: `recording.power`, changed only by
/// effects in the meters.
[[nodiscard]] std::vector<double> metered_kW(const Recording& recording, Utility utility,
                                             const HiddenEffects& effects,
                                             const metering::LocalCalendar& calendar);

}  // namespace recald::simulators
