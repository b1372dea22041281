/// EnergyPlus weather files as they are.
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
  double utc_offset_h;   ///< Of local standard time, the file's clock all year.
  double elevation_m;
};

struct EpwWeather {
  EpwLocation location;
  weather::WeatherSeries series;  ///< On the UTC hour, missing codes absent.
  int year;                       ///< The calendar year that the series stands for.
  bool typical;          ///< Months are stitched from different years: not the weather of `year`.
  bool leap_day;         ///< The file has a 29 February.
  int humidity_clipped;  ///< Hours above 100 %, set to 100.
  std::vector<std::string> notes;  ///< One sentence each: leap day repeated or dropped, …
};

/// Reads a year of hourly weather.
///
/// Hours run 1…24 and name the END of the hour in local standard time without summer time, so row
/// "1,1,1" is the first hour of the year there. Irradiance is the hour's; temperature, humidity,
/// wind and pressure are values at its end, and become means of the hour. Missing codes become
/// absent. The weekday of the header is not used: it comes from the calendar of `year`.
/// @param year  the calendar year to lay the rows on. Absent: the file's own year, or, where
///              a typical file stitches several, the year of its first row. In a leap year a file
///              without 29 February repeats the 28th; otherwise a 29 February is dropped. Both
///              noted.
/// @param values  What temperature, humidity, wind and pressure are in a file that differs.
/// @return the weather, or not_found, io_failed, malformed (a header line, a field, rows out of
///         order), not_enough_data (a file that ends early: the message names the first hour
///         that is missing).
/// @see EnergyPlus, Auxiliary Programs, "EnergyPlus Weather File (EPW) Data Dictionary".
[[nodiscard]] Result<EpwWeather> read_epw(
    const std::filesystem::path& file, std::optional<int> year = {},
    weather::RecordedValues values = weather::RecordedValues::instant);
[[nodiscard]] Result<EpwWeather> read_epw_text(
    std::string_view text, std::string_view name, std::optional<int> year = {},
    weather::RecordedValues values = weather::RecordedValues::instant);

}  // namespace recald::epw
