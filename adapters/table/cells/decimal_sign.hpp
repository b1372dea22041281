/// Which decimal sign the numbers of a table have.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "adapters/table/cells/column_kinds.hpp"
#include "core/result.hpp"

namespace recald::table {

struct DecimalSign {
  char decimal = '.';
  std::string because;  ///< Begins with "guessed" if nothing decides.
};

/// @param values  Columns with the numbers of meters.
/// @param others  Columns with further numbers, such as prices, which decide where those leave it
///                open: they are written by the same hand.
/// @return malformed: the signs change; the sentence says in which rows.
[[nodiscard]] Result<DecimalSign> guess_decimal(std::span<const KeptRow* const> rows,
                                                std::span<const std::size_t> values,
                                                std::span<const std::size_t> others);

}  // namespace recald::table
