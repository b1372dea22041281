/// Tables and cells of scores.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/blind/scoring/intervals.hpp"

namespace recald::blind {

/// Collects rows of one width. Bars inside a cell are escaped.
class MarkdownTable {
 public:
  explicit MarkdownTable(const std::vector<std::string>& heads);
  /// @pre as many cells as heads.
  void add(const std::vector<std::string>& cells);
  /// The table and a blank line; empty without rows.
  [[nodiscard]] std::string text() const;

 private:
  std::size_t columns_;
  bool has_rows_ = false;
  std::string text_;
};

/// "45 of 60: 75 % (62 to 85)"; a dash without cases.
[[nodiscard]] std::string share_cell(const std::optional<Score>& score);

/// "0.62 (0.41 to 0.80)", or without an interval "0.62 (n = 3)".
[[nodiscard]] std::string number_cell(const std::optional<Score>& score, int decimals = 2);

}  // namespace recald::blind
