/// Tables with a column a day and a row for each time of the day, turned so that rows are days.
#pragma once

#include <memory>

#include "adapters/table/row_source.hpp"
#include "adapters/table/table_shape.hpp"

namespace recald::table {

inline constexpr std::string_view kDateColumn = "date";  ///< Of a turned table.

/// Rows with "date", whatever else the table has, and a column for each time of the day. All of the
/// table is kept in memory, up to four million cells. Rows that differ in other columns are of
/// different meters; each has its own days.
/// @param shape  Its clock column has the times of the day.
[[nodiscard]] std::unique_ptr<RowSource> turned_rows(std::unique_ptr<RowSource> table,
                                                     const TableShape& shape);

}  // namespace recald::table
