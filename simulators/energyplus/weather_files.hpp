/// Simulated weather for EnergyPlus, and the same weather for the site file.
#pragma once

#include <string>
#include <vector>

#include "simulators/climate/weather.hpp"

namespace recald::simulators::energyplus {

/// An hour by the rule of EnergyPlus weather files: states at its end, radiation of the hour.
struct WeatherHour {
  metering::Instant end;
  Outdoors at_end;
  double global_W_m2;
  double beam_normal_W_m2;
  double diffuse_W_m2;
};

/// Whole calendar years of the zone's standard time. The same seed gives the same weather.
[[nodiscard]] std::vector<WeatherHour> simulate_hours(const Climate& climate, int first_year,
                                                      int years, std::uint64_t seed,
                                                      const metering::LocalCalendar& calendar);

/// The text of an EPW file: one year of the hours, with its weekdays, summer time and holidays.
/// @see EnergyPlus, Auxiliary Programs, "EnergyPlus Weather File (EPW) Data Dictionary".
[[nodiscard]] std::string epw_text(const std::vector<WeatherHour>& hours, int year,
                                   const Place& place, const metering::LocalCalendar& calendar,
                                   const std::vector<metering::Day>& holidays);

/// All hours as recald reads them, stamped at their end, in UTC.
[[nodiscard]] std::string weather_csv(const std::vector<WeatherHour>& hours);

}  // namespace recald::simulators::energyplus
