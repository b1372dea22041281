/// Rows whose meter is named by several columns, or by a line above their block.
#pragma once

#include <memory>

#include "adapters/table/row_source.hpp"
#include "adapters/table/table_shape.hpp"

namespace recald::table {

inline constexpr std::string_view kNamesApart = " / ";  ///< Between the texts of several columns.

/// The same rows, with the texts of `further_meter_columns` joined to that of the meter column.
[[nodiscard]] std::unique_ptr<RowSource> joined_names(std::unique_ptr<RowSource> rows,
                                                      const TableShape& shape);

/// The same rows with a further column, "#title": the line above the header that they stand below.
/// Lines of one or two cells without a time are taken for titles and are not handed out.
[[nodiscard]] std::unique_ptr<RowSource> titled_rows(std::unique_ptr<RowSource> rows,
                                                     const TableShape& shape);

}  // namespace recald::table
