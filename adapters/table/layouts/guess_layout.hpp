/// Finds out which way the times of a table run, and shows its first rows as a table of rows.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adapters/table/sniff.hpp"
#include "adapters/table/table_shape.hpp"

namespace recald::table {

struct LayoutGuess {
  Layout layout = Layout::rows;
  std::string because;
  std::string clock_column;   ///< Of a table with a column a day: its times of the day.
  std::vector<KeptRow> rows;  ///< The same readings with a row each, to be guessed from.
};

/// @param rows  The first ones of a table.
/// @return nothing for a table of rows
[[nodiscard]] std::optional<LayoutGuess> guess_layout(std::span<const KeptRow> rows);

/// Makes a guess about those rows one about the table itself.
void settle_layout(const LayoutGuess& layout, TableGuess& guess);

}  // namespace recald::table
