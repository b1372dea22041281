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
  nem12,         ///< Interval data of the Australian market.
  influx,        ///< Annotated CSV of InfluxDB.
  json,          ///< A list of readings, or objects line by line.
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

/// Which way the times of a table run.
enum class Layout : std::uint8_t {
  rows,           ///< A row for each time.
  row_a_day,      ///< A row for each day, with a column for each time of the day.
  column_a_time,  ///< A column for each time, or for each day where rows are times of the day.
};

inline constexpr std::array<std::string_view, 3> kLayouts{"rows", "row_a_day", "column_a_time"};
[[nodiscard]] inline std::string_view to_string(Layout layout) {
  return kLayouts[static_cast<std::size_t>(layout)];
}

/// Columns of the rows that other layouts and containers are turned into.
inline constexpr std::string_view kStampColumn = "timestamp";
inline constexpr std::string_view kValueColumn = "value";
inline constexpr std::string_view kFlagColumn = "flag";
/// The line above a block's header, for tables that stand below each other.
inline constexpr std::string_view kTitleColumn = "#title";

/// Columns are named by their header, or "#3" for the third column.
struct TableShape {
  Container container = Container::text;
  Layout layout = Layout::rows;
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
  /// Columns whose texts are joined to that of `meter_column` by " / ".
  std::vector<std::string> further_meter_columns;
  std::string unit_column;  ///< Units, in a table of one row per meter. Empty: as declared.
  std::string flag_column;  ///< How good each value is; empty: nothing says it.
  std::vector<std::string> missing_flags = {};    ///< There: what beside them is no data.
  std::vector<std::string> estimated_flags = {};  ///< … and what beside them was not measured.
  bool operator==(const TableShape&) const = default;
};

/// Whether a container says itself what its readings, meters and units are.
[[nodiscard]] inline bool describes_itself(Container container) {
  return container == Container::green_button || container == Container::nem12 ||
         container == Container::influx;
}

/// The columns of the rows that such a container is turned into.
[[nodiscard]] inline TableShape described_shape(Container container) {
  TableShape shape{.container = container,
                   .time_column = std::string{kStampColumn},
                   .meter_column = "meter",
                   .unit_column = "unit"};
  if (container == Container::influx) return shape;
  shape.flag_column = "quality";
  if (container == Container::nem12) {
    shape.estimated_flags = {"E", "F", "S"};  // estimated, final substitute, substituted
  } else {
    // ESPI: edited by hand, estimated by a reference day or by a line, projected, mixed.
    shape.estimated_flags = {"7", "8", "9", "12", "13"};
  }
  return shape;
}
[[nodiscard]] inline TableShape green_button_shape() {
  return described_shape(Container::green_button);
}

/// One meter of a table: its rows, by `name` in the meter column, or its column.
struct TableMeter {
  csv::MeterRows rows;
  std::string column;  ///< The column with its values.
  std::string unit;    ///< Of the values; empty: taken from the unit column.
  /// Rows and columns of the same load, as of another tariff or phase; see `MeterParts`.
  std::vector<std::string> further_names{};
  std::vector<std::string> further_columns{};
};

}  // namespace recald::table
