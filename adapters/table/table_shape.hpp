/// How to read the rows of an export.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/csv/readings_csv.hpp"
#include "adapters/table/cells/stamps.hpp"

namespace recald::table {

/// The format of an export.
enum class Container : std::uint8_t {
  text,          ///< Cells separated by commas, semicolons, tabs or bars.
  xlsx,          ///< A workbook.
  green_button,  ///< ESPI XML.
};

/// How a column with the time of day counts.
enum class ClockFormat : std::uint8_t {
  time,         ///< A clock: 14:15, "00:00 - 00:15", or an hour from 0 to 23.
  hour_ending,  ///< 1…24 is the hour of the clock that ends; so are 1…48 and 1…96 of its parts.
  interval_number,  ///< The n-th interval since midnight: 1…25, 1…50, 1…100.
};

inline constexpr std::array<std::string_view, 3> kClockFormats{"time", "hour_ending",
                                                               "interval_number"};
[[nodiscard]] inline std::string_view to_string(ClockFormat format) {
  return kClockFormats[static_cast<std::size_t>(format)];
}

/// Columns are named by their header, or "#3" for the third column.
struct TableShape {
  Container container = Container::text;
  char separator = '\0';     ///< Of a text; 0: taken from the header.
  char decimal = '.';        ///< Or ','.
  std::string sheet;         ///< Of a workbook; empty: the first.
  std::string time_column;   ///< Date and time, or only the date.
  std::string clock_column;  ///< The time, if it has its own column; else empty.
  ClockFormat clock_format = ClockFormat::time;
  std::chrono::seconds interval{0};  ///< That a clock column counts; 0: hours.
  TimeFormat time_format = TimeFormat::year_first;
  std::string timezone;      ///< For stamps without an offset; empty: the site's.
  std::string meter_column;  ///< One row per meter: its name. Empty: one column per meter.
  std::string unit_column;   ///< Units, in a table of one row per meter. Empty: as declared.
  std::string flag_column;   ///< How good each value is; empty: nothing says it.
  std::vector<std::string> missing_flags = {};    ///< There: what beside them is no data.
  std::vector<std::string> estimated_flags = {};  ///< … and what beside them was not measured.
  bool operator==(const TableShape&) const = default;
};

/// The columns of the rows that a Green Button feed is turned into.
[[nodiscard]] inline TableShape green_button_shape() {
  return {.container = Container::green_button,
          .time_column = "timestamp",
          .meter_column = "meter",
          .unit_column = "unit",
          .flag_column = "quality",
          // Edited by hand, estimated by a reference day or by a line, projected, mixed (ESPI).
          .estimated_flags = {"7", "8", "9", "12", "13"}};
}

/// One meter of a table: its rows, by `name` in the meter column, or its column.
struct TableMeter {
  csv::MeterRows rows;
  std::string column;  ///< The column with its values.
  std::string unit;    ///< Of the values; empty: taken from the unit column.
};

}  // namespace recald::table
