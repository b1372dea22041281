#include "adapters/table/layouts/layout_rows.hpp"

#include <algorithm>

#include "adapters/table/layouts/day_rows.hpp"
#include "adapters/table/layouts/time_columns.hpp"
#include "adapters/table/layouts/turned_table.hpp"
#include "adapters/table/loads/named_rows.hpp"

namespace recald::table {
namespace {

bool has_titles(const TableShape& shape) {
  const auto& further = shape.further_meter_columns;
  return shape.meter_column == kTitleColumn ||
         std::find(further.begin(), further.end(), kTitleColumn) != further.end();
}

std::unique_ptr<RowSource> rows_of_times(std::unique_ptr<RowSource> table, const TableShape& shape,
                                         const metering::LocalCalendar* calendar) {
  if (shape.layout == Layout::row_a_day) return day_rows(std::move(table), shape, calendar);
  if (shape.layout == Layout::rows) return table;
  if (shape.clock_column.empty()) return time_rows(std::move(table), shape);
  TableShape turned = shape;
  turned.time_column = kDateColumn;
  return day_rows(turned_rows(std::move(table), shape), turned, calendar);
}

}  // namespace

std::unique_ptr<RowSource> layout_rows(std::unique_ptr<RowSource> table, const TableShape& shape,
                                       const metering::LocalCalendar* calendar) {
  auto rows = rows_of_times(std::move(table), shape, calendar);
  if (has_titles(shape)) rows = titled_rows(std::move(rows), shape_of_rows(shape));
  if (!shape.further_meter_columns.empty()) rows = joined_names(std::move(rows), shape);
  return rows;
}

TableShape shape_of_rows(const TableShape& shape) {
  TableShape of_rows = shape;
  if (shape.layout == Layout::rows) return of_rows;
  of_rows.layout = Layout::rows;
  of_rows.time_column = kStampColumn;
  of_rows.clock_column.clear();
  // Of a column a time the header's stamps are handed on; others are written by us.
  const bool has_own_stamps = shape.layout == Layout::column_a_time && shape.clock_column.empty();
  if (!has_own_stamps) of_rows.time_format = TimeFormat::year_first;
  return of_rows;
}

}  // namespace recald::table
