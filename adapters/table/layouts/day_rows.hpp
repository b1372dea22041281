/// Tables with a row a day and a column for each time of the day, as rows of one reading each.
#pragma once

#include <memory>

#include "adapters/table/row_source.hpp"
#include "adapters/table/table_shape.hpp"
#include "core/metering/civil_time.hpp"

namespace recald::table {

/// Rows with the columns "timestamp", "value", "flag" (where flags stand between the values) and
/// whatever else the table has. Stamps are starts of intervals, on the table's clock; those of a
/// day with a clock change say their offset where the columns are counted from midnight.
///
/// On the day of 23 hours, the columns of the hour that the clock skips are blank, or those at the
/// end of the day are. On the day of 25 hours, intervals are counted from midnight if there are
/// columns for all of them; an hour that stands for two is halved if it holds about twice as much
/// as its neighbours, and a note says so. Rows may come newest first; they are kept in memory then.
///
/// @param shape     Its time column has the dates. Its decimal sign is that of the values.
/// @param calendar  Of the table's clock, outlives the rows; null: all days have 24 hours.
[[nodiscard]] std::unique_ptr<RowSource> day_rows(std::unique_ptr<RowSource> table,
                                                  const TableShape& shape,
                                                  const metering::LocalCalendar* calendar);

}  // namespace recald::table
