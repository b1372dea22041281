/// Which columns tell rows apart that have the same time: those that name a meter or a register.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adapters/table/row_source.hpp"
#include "adapters/table/table_shape.hpp"

namespace recald::table {

struct ColumnsApart {
  std::vector<std::string> columns;  ///< As a site file names them; at least one.
  std::size_t groups = 0;            ///< So many different texts they have together.
  /// Columns that have no more different texts, such as the number of a meter beside its name: no
  /// readings.
  std::vector<std::string> alike;
};

/// Looks for the fewest columns by whose texts the rows fall into groups that are each in order of
/// time, without a time that comes twice. Columns with few different texts come into question, but
/// none that says how a value came about.
/// @param open    Opens the rows; called up to three times.
/// @param shape   Says where times are.
/// @param values  Columns that are no names.
/// @return nothing if no such columns are there
[[nodiscard]] Result<std::optional<ColumnsApart>> columns_that_tell_apart(
    const std::function<Result<std::unique_ptr<RowSource>>()>& open, const TableShape& shape,
    std::span<const std::string> values);

}  // namespace recald::table
