/// What stands in a column of an export.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace recald::table {

/// A row that is kept.
struct KeptRow {
  std::uint64_t number;
  std::vector<std::string> cells;  ///< UTF-8.
};

[[nodiscard]] inline std::string_view cell_of(const KeptRow& row, std::size_t column) {
  return column < row.cells.size() ? std::string_view{row.cells[column]} : std::string_view{};
}

/// Whether a cell is a number with either decimal sign, alone or with a unit of a meter behind it.
[[nodiscard]] bool is_number(std::string_view cell);

/// Whether a cell is a date in some order of its parts, and not a plain number, except one
/// like 202403311415.
[[nodiscard]] bool is_date(std::string_view cell);

/// The contents of one column in the rows below the header.
struct ColumnKinds {
  std::size_t filled = 0;
  std::size_t numbers = 0;
  std::size_t with_unit = 0;  ///< Numbers with a unit behind them.
  std::size_t times_of_day = 0;
  std::set<std::string> texts;               ///< Different texts, up to a hundred.
  std::map<std::string, std::size_t> units;  ///< Behind numbers, with how many.
  std::size_t words = 0;                     ///< Cells that are not numbers.
  std::size_t long_figures = 0;              ///< Of eight figures or more, and nothing else.
  bool is_whole = true;                      ///< All cells are whole numbers.
  std::size_t steps = 0;                     ///< Cells that are one more than the cell above …
  std::size_t steps_back = 0;                ///< … or one less.

  [[nodiscard]] bool is_mostly(std::size_t count) const;
  /// Texts come again and again, as those of names and flags do.
  [[nodiscard]] bool repeats() const;
  /// Whole numbers that rise by one from row to row, or fall by one.
  [[nodiscard]] bool counts_rows() const;
  /// Long figures that stay the same for rows and rows, as no amount does.
  [[nodiscard]] bool is_identifier() const;
};

[[nodiscard]] std::vector<ColumnKinds> kinds_of(std::span<const KeptRow* const> rows,
                                                std::size_t width);

}  // namespace recald::table
