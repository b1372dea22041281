/// CSV of InfluxDB as its query language writes it: several tables, with or without annotations.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "adapters/csv/line_reader.hpp"
#include "adapters/table/row_source.hpp"

namespace recald::table {

/// Whether one of a text's first lines begins an annotation, or is a header with _time and a
/// value.
[[nodiscard]] bool is_influx_csv(std::span<const std::string> first_lines);

/// Rows with the columns "timestamp" (of _time), "meter", "value", "unit". The meter is the texts
/// of the columns that name a series, joined by " / ": measurement, field and tags. In a table
/// without _value, each column of numbers is a field. The unit is one that a measurement, a field
/// or a tag is or ends with, else blank. Blank cells have their column's default.
/// The source fails with malformed where the text is an answer with an error.
[[nodiscard]] std::unique_ptr<RowSource> influx_rows(csv::ByteSource bytes);

}  // namespace recald::table
