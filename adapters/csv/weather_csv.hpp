/// Recorded weather: `timestamp,dry_bulb_C,rel_humidity_pct,wind_speed_m_s,wind_dir_deg,ghi_W_m2`.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/csv/line_issues.hpp"
#include "core/result.hpp"
#include "core/weather/recorded_values.hpp"

namespace recald::csv {

struct WeatherCsvOptions {
  Stamps stamps = Stamps::start;
  /// Of temperature, humidity, wind and pressure. Absent: as the record shows against the sun;
  /// where it cannot tell, instants from a step of an hour on, as weather services report, and
  /// means below, as loggers store.
  std::optional<weather::RecordedValues> values;
  std::size_t issues_listed_max = 100;
};

struct WeatherCsv {
  weather::WeatherSeries series;  ///< Hourly, gaps absent; see weather::fill_gaps.
  std::chrono::seconds step;      ///< Commonest step of the rows.
  weather::ValuesTaken values;
  std::vector<std::string> ignored_columns;
  std::uint64_t rows = 0;
  LineIssues issues;  ///< Bad lines, impossible values (kept out as blanks), repeated stamps.
};

/// `timestamp` and `dry_bulb_C`, or `dry_bulb_F`, are required, the other known columns (also
/// dni_W_m2, dhi_W_m2, pressure_Pa) optional, in any order; unknown ones are ignored and named.
/// Blanks are absent values. Same text rules as `read_readings`.
/// @return not_found, io_failed, malformed (header), not_enough_data (no usable row).
[[nodiscard]] Result<WeatherCsv> read_weather(const std::filesystem::path& file,
                                              const WeatherCsvOptions& options);
[[nodiscard]] Result<WeatherCsv> read_weather_text(std::string_view text, std::string_view name,
                                                   const WeatherCsvOptions& options);

}  // namespace recald::csv
