/// EnergyPlus weather files.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/weather/recorded_values.hpp"

namespace recald::epw {

struct EpwLocation {
  std::string city;
  std::string country;
  double latitude_deg;   ///< North positive.
  double longitude_deg;  ///< East positive.
  double utc_offset_h;   ///< Of local standard time, which the file uses all year.
  double elevation_m;
};

struct EpwWeather {
  EpwLocation location;
  weather::WeatherSeries series;  ///< On the UTC hour, missing codes absent.
  int year;                       ///< The calendar year of the series.
  bool typical;          ///< Months are from different years: this is not the weather of `year`.
  bool leap_day;         ///< The file has a 29 February.
  int humidity_clipped;  ///< Hours above 100 %, set to 100.
  std::vector<std::string> notes;  ///< One sentence each: leap day repeated or dropped, …
};

/// Reads a year of hourly weather.
///
/// Hours run 1…24 and name the END of the hour in local standard time without summer time, so row
/// "1,1,1" is the first hour of the year there. Irradiance is the hour's; temperature, humidity,
/// wind and pressure are values at its end, and are converted to means of the hour. Missing codes
/// become absent values. The header's weekday is ignored; it follows from the calendar of `year`.
/// @param year  The calendar year to place the rows in. Absent: the file's own year, or for a
///              typical year made of several, that of its first row. In a leap year a file without
///              29 February repeats the 28th; otherwise a 29 February is dropped. A note says so.
/// @param values  What temperature, humidity, wind and pressure are in a file that differs.
/// Values that cannot occur on the ground are absent, and noted.
/// @return the weather, or not_found, io_failed, invalid_value (a variable that has such values in
///         more than one hour of twenty), malformed (a header line, a field, rows
///         out of order), not_enough_data (a file that ends early: the message names the
///         first missing hour).
/// @see EnergyPlus, Auxiliary Programs, "EnergyPlus Weather File (EPW) Data Dictionary".
[[nodiscard]] Result<EpwWeather> read_epw(
    const std::filesystem::path& file, std::optional<int> year = {},
    weather::RecordedValues values = weather::RecordedValues::instant);
[[nodiscard]] Result<EpwWeather> read_epw_text(
    std::string_view text, std::string_view name, std::optional<int> year = {},
    weather::RecordedValues values = weather::RecordedValues::instant);

}  // namespace recald::epw
