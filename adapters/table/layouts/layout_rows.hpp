/// Rows of one time each, of a table in any layout.
#pragma once

#include <memory>

#include "adapters/table/row_source.hpp"
#include "adapters/table/table_shape.hpp"
#include "core/metering/civil_time.hpp"

namespace recald::table {

/// Turns the layout, adds titles, and joins the texts of several meter columns, as the shape asks.
/// @param table     The rows as the file has them.
/// @param calendar  As for `open_rows`.
[[nodiscard]] std::unique_ptr<RowSource> layout_rows(std::unique_ptr<RowSource> table,
                                                     const TableShape& shape,
                                                     const metering::LocalCalendar* calendar);

/// How those rows are read.
[[nodiscard]] TableShape shape_of_rows(const TableShape& shape);

}  // namespace recald::table
