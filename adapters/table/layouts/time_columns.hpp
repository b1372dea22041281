/// Tables whose times run across the header, as rows of one reading each.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "adapters/table/row_source.hpp"
#include "adapters/table/table_shape.hpp"

namespace recald::table {

inline constexpr std::size_t kTimeColumnsMin = 8;  ///< Fewer stamps are no header of times.
inline constexpr std::size_t kTimeColumnsMax =
    40'000;  ///< A year of quarters of an hour has 35 136.

/// Columns of a header whose texts are times.
struct TimeColumns {
  std::vector<std::size_t> places;  ///< Indices in the header.
  bool are_days = false;            ///< Dates without a time: a column a day.
};

/// @return nothing for a row that is no such header: most of its cells must be times that rise or
///         fall from cell to cell.
[[nodiscard]] std::optional<TimeColumns> find_time_columns(std::span<const std::string_view> header,
                                                           TimeFormat format);

/// Rows with the columns "timestamp", "value" and whatever else the table has.
[[nodiscard]] std::unique_ptr<RowSource> time_rows(std::unique_ptr<RowSource> table,
                                                   const TableShape& shape);

}  // namespace recald::table
