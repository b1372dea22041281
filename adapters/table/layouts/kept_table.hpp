/// Rows of a table that outlive their source. Internal to this folder.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/table/row_source.hpp"

namespace recald::table {

struct KeptTableRow {
  KeptTableRow() = default;
  explicit KeptTableRow(const TableRow& row)
      : number{row.number},
        cells{row.cells.begin(), row.cells.end()},
        text{row.text},
        problem{row.problem},
        is_terminated{row.is_terminated} {}

  [[nodiscard]] std::string_view cell(std::size_t column) const {
    return column < cells.size() ? std::string_view{cells[column]} : std::string_view{};
  }
  [[nodiscard]] bool is_empty() const {
    return std::all_of(cells.begin(), cells.end(), [](const auto& cell) { return cell.empty(); });
  }

  std::uint64_t number = 0;
  std::vector<std::string> cells;
  std::string text;
  std::string problem;
  bool is_terminated = true;
};

}  // namespace recald::table
