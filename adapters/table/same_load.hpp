/// Power beside energy, or Wh beside kWh: two columns of one load.
#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adapters/table/cells/column_kinds.hpp"

namespace recald::table {

/// A column with values, its name and unit, and its numbers, NaN where there is none.
struct LoadColumn {
  std::string name;
  std::string unit;
  std::vector<double> values;  ///< One a row.
};

/// The column that has the load of `columns[index]` as well and is to be taken instead, if there
/// is one: its names differ in no more than words for energy and power, or every value is the same.
struct SameLoad {
  std::size_t as;       ///< Index of the column that is taken.
  bool agrees = true;   ///< False: the names say so, but the values differ.
  std::size_t row = 0;  ///< Then the first of `values` that does.
};
/// @param interval  Between rows; 0: not known.
[[nodiscard]] std::optional<SameLoad> same_load_of(std::span<const LoadColumn> columns,
                                                   std::size_t index,
                                                   std::chrono::seconds interval);

}  // namespace recald::table
