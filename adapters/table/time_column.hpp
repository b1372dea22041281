/// Which column of an export has the times, and where its rows of data begin.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "adapters/table/cells/column_kinds.hpp"
#include "adapters/table/cells/stamps.hpp"

namespace recald::table {

struct TimeColumn {
  std::size_t column = 0;
  std::size_t first_row = 0;                   ///< Of the rows with data.
  bool is_counted = false;                     ///< Days of a spreadsheet, or seconds since 1970.
  TimeFormat format = TimeFormat::year_first;  ///< Of counted ones.
};

/// Of several columns with times: one that changes, rather that of starts than of ends.
/// @param rows  Without blank ones.
/// @param told  The only column that may have them, if somebody says so.
[[nodiscard]] std::optional<TimeColumn> find_time_column(std::span<const KeptRow* const> rows,
                                                         std::size_t width,
                                                         std::optional<std::size_t> told = {});

/// The last text of a column above a row: its header, if there is one.
[[nodiscard]] std::string_view text_above(std::span<const KeptRow* const> rows,
                                          std::size_t first_row, std::size_t column);

}  // namespace recald::table
