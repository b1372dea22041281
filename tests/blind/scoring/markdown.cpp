#include "tests/blind/scoring/markdown.hpp"

#include <fmt/format.h>

#include <cassert>

namespace recald::blind {
namespace {

std::string line_of(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) {
    line += ' ';
    for (const char c : cell) {
      if (c == '|') line += '\\';
      line += c == '\n' || c == '\r' ? ' ' : c;
    }
    line += " |";
  }
  return line + "\n";
}

/// Whole per cents; one decimal where rounding would say 0 or 100 of something that is neither.
std::string percent(double share) {
  const double value = 100.0 * share;
  const bool is_extreme = (value > 0.0 && value < 1.0) || (value > 99.0 && value < 100.0);
  return fmt::format("{:.{}f}", value, is_extreme ? 1 : 0);
}

}  // namespace

MarkdownTable::MarkdownTable(const std::vector<std::string>& heads) : columns_(heads.size()) {
  text_ = line_of(heads) + line_of(std::vector<std::string>(columns_, "---"));
}

void MarkdownTable::add(const std::vector<std::string>& cells) {
  assert(cells.size() == columns_);
  text_ += line_of(cells);
  has_rows_ = true;
}

std::string MarkdownTable::text() const { return has_rows_ ? text_ + "\n" : ""; }

std::string share_cell(const std::optional<Score>& score) {
  if (!score) return "-";
  std::string cell = score->hits ? fmt::format("{} of {}: ", *score->hits, score->cases) : "";
  cell += percent(score->value) + " %";
  if (!score->interval) return cell;
  return cell +
         fmt::format(" ({} to {})", percent(score->interval->low), percent(score->interval->high));
}

std::string number_cell(const std::optional<Score>& score, int decimals) {
  if (!score) return "-";
  std::string cell = fmt::format("{:.{}f}", score->value, decimals);
  if (!score->interval) return cell + fmt::format(" (n = {})", score->cases);
  return cell + fmt::format(" ({:.{}f} to {:.{}f})", score->interval->low, decimals,
                            score->interval->high, decimals);
}

}  // namespace recald::blind
