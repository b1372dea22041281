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
  /// Instants or means, for temperature, humidity, wind and pressure. Absent: inferred from the
  /// record and the sun; if that fails, instants for steps of an hour or more, as weather services
  /// report, and means for shorter steps, as loggers store.
  std::optional<weather::RecordedValues> values;
  std::size_t issues_listed_max = 100;
};

struct WeatherCsv {
  weather::WeatherSeries series;  ///< Hourly, gaps absent; see weather::fill_gaps.
  std::chrono::seconds step;      ///< Commonest step of the rows.
  weather::ValuesTaken values;
  std::vector<std::string> ignored_columns;
  std::uint64_t rows = 0;
  LineIssues issues;  ///< Bad lines, impossible values (made blank), repeated stamps.
};

/// `timestamp` and `dry_bulb_C`, or `dry_bulb_F`, are required; the other known columns (also
/// dni_W_m2, dhi_W_m2, pressure_Pa) are optional, in any order. Unknown ones are ignored and named.
/// Blanks are absent values. Same text rules as `read_readings`.
/// @return the weather; or not_found, io_failed, malformed (header), not_enough_data (no good row).
[[nodiscard]] Result<WeatherCsv> read_weather(const std::filesystem::path& file,
                                              const WeatherCsvOptions& options);
[[nodiscard]] Result<WeatherCsv> read_weather_text(std::string_view text, std::string_view name,
                                                   const WeatherCsvOptions& options);

}  // namespace recald::csv
