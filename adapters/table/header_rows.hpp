/// The rows of an export that name its columns.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "adapters/table/cells/column_kinds.hpp"
#include "adapters/table/time_column.hpp"

namespace recald::table {

struct HeaderRows {
  std::vector<std::string> names;  ///< By which columns are found again, squeezed; none: no header.
  const KeptRow* units = nullptr;  ///< A row of units below the names.
  std::vector<std::string> texts;  ///< Of each column, the rows of the header one after the other.
  std::size_t above = 0;           ///< Rows above the header.
};

/// @param rows   Without blank ones.
/// @param kinds  Of the rows with data.
[[nodiscard]] HeaderRows find_header_rows(std::span<const KeptRow* const> rows,
                                          const TimeColumn& times,
                                          std::span<const ColumnKinds> kinds);

/// The unit that the rows above a table say all values have; empty: none, or several.
struct UnitAbove {
  std::string unit;
  std::uint64_t row = 0;
};
[[nodiscard]] UnitAbove unit_above(std::span<const KeptRow* const> rows);

/// The text with one blank where it has several, or line breaks.
[[nodiscard]] std::string squeezed(std::string_view text);

}  // namespace recald::table
