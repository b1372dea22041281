/// How the rows of an export are to be read.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/csv/readings_csv.hpp"
#include "adapters/table/stamps.hpp"

namespace recald::table {

/// What an export is written in.
enum class Container : std::uint8_t {
  text,          ///< Cells apart by commas, semicolons, tabs or bars.
  xlsx,          ///< A workbook.
  green_button,  ///< ESPI XML.
};

/// Names of columns are those of the header, or "#3" for the third column.
struct TableShape {
  Container container = Container::text;
  char separator = '\0';     ///< Of a text; 0: as its header shows.
  char decimal = '.';        ///< Or ','.
  std::string sheet;         ///< Of a workbook; empty: its first one.
  std::string time_column;   ///< Date and time, or the date alone.
  std::string clock_column;  ///< The time, where it has a column of its own; else empty.
  TimeFormat time_format = TimeFormat::year_first;
  std::string timezone;      ///< Of stamps without an offset; empty: the site's.
  std::string meter_column;  ///< A row a meter: the column with its name. Empty: a column a meter.
  std::string unit_column;   ///< A row a meter: the column with its unit. Empty: as declared.
  bool operator==(const TableShape&) const = default;
};

/// Green Button feeds come as rows of these columns.
[[nodiscard]] inline TableShape green_button_shape() {
  return {.container = Container::green_button,
          .time_column = "timestamp",
          .meter_column = "meter",
          .unit_column = "unit"};
}

/// One meter of a table: its rows, by `name` in the meter column, or its column.
struct TableMeter {
  csv::MeterRows rows;
  std::string column;  ///< With its values.
  std::string unit;    ///< Of the values; empty: as the unit column says.
};

}  // namespace recald::table
