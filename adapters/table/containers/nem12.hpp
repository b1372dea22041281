/// Interval data of the Australian market: AEMO's Meter Data File Format, NEM12.
#pragma once

#include <memory>
#include <string_view>

#include "adapters/csv/line_reader.hpp"
#include "adapters/table/row_source.hpp"

namespace recald::table {

/// Whether a text begins with a record of NEM12 or NEM13.
[[nodiscard]] bool is_nem12(std::string_view first_line);

/// Rows with the columns "timestamp" (start of the interval), "meter" ("NMI / suffix"), "value",
/// "unit", "quality" (A, E, F, N, S, as the format has them). Times are those of the format: UTC+10
/// all year, wherever the meter is. A value of quality N, "no data", comes as a blank. Channels
/// without energy, such as reactive ones, are left out, which the notes say. One day is held in
/// memory at a time.
///
/// The source fails with malformed for NEM13, whose registers are read every few months.
[[nodiscard]] std::unique_ptr<RowSource> nem12_rows(csv::ByteSource bytes);

}  // namespace recald::table
