#include "adapters/table/cell_number.hpp"

#include <algorithm>
#include <array>

#include "adapters/csv/fields.hpp"
#include "core/text/ascii.hpp"

namespace recald::table {
namespace {

constexpr std::string_view kNoBreakSpace = "\xC2\xA0";
constexpr std::string_view kNarrowNoBreakSpace = "\xE2\x80\xAF";

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Bytes of a thousands separator at the front of `text`; 0: there is none.
std::size_t group_sign(std::string_view text, char decimal) {
  if (text.empty()) return 0;
  if (text.front() == ' ' || text.front() == '\'') return 1;
  if (text.front() == (decimal == ',' ? '.' : ',')) return 1;
  for (const std::string_view space : {kNoBreakSpace, kNarrowNoBreakSpace}) {
    if (text.substr(0, space.size()) == space) return space.size();
  }
  return 0;
}

/// The whole part without thousands separators; nothing if they are in the wrong places.
std::optional<std::string> without_groups(std::string_view whole, char decimal) {
  std::string digits;
  std::size_t in_group = 0;
  bool has_groups = false;
  while (!whole.empty()) {
    if (is_digit(whole.front())) {
      digits += whole.front();
      ++in_group;
      whole.remove_prefix(1);
      continue;
    }
    const std::size_t sign = group_sign(whole, decimal);
    const bool is_first = !has_groups;
    if (sign == 0 || in_group == 0 || (is_first ? in_group > 3 : in_group != 3)) return {};
    if (is_first && digits == "0") return {};  // 0,125 has no thousands
    has_groups = true;
    in_group = 0;
    whole.remove_prefix(sign);
  }
  if (has_groups && in_group != 3) return {};
  return digits;
}

}  // namespace

bool is_blank(std::string_view cell) {
  if (cell.empty()) return true;
  if (cell.size() > 11) return false;
  std::string word;
  for (const char c : cell) {
    word += to_lower(c);
  }
  constexpr std::array<std::string_view, 16> kWords{
      "-",   "--",      "na",      "n/a", "#n/a",        "nan",     "null",    "none",
      "nil", "no data", "missing", "---", "unavailable", "unknown", "offline", "no value"};
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

std::optional<double> parse_cell(std::string_view cell, char decimal) {
  double value = 0.0;
  if (decimal == '.' && !cell.empty() && csv::parse_plain_decimal(cell, value) == cell.size()) {
    return value;
  }
  const std::size_t sign = !cell.empty() && (cell.front() == '-' || cell.front() == '+') ? 1 : 0;
  std::size_t end = cell.find(decimal, sign);
  if (end == std::string_view::npos) end = std::min(cell.find_first_of("eE", sign), cell.size());
  const auto whole = without_groups(cell.substr(sign, end - sign), decimal);
  if (!whole) return {};
  std::string text{cell.substr(0, sign)};
  text += whole->empty() ? "0" : *whole;
  std::string_view rest = cell.substr(end);
  if (whole->empty() && (rest.size() < 2 || !is_digit(rest[1]))) return {};
  if (!rest.empty() && rest.front() == decimal) {
    text += '.';
    rest.remove_prefix(1);
    if (rest.empty()) text += '0';
  }
  text += rest;
  return csv::parse_number(text);
}

std::string cell_problem(std::string_view cell, char decimal) {
  return csv::in_quotes(cell) + " is no number with a decimal " +
         (decimal == ',' ? "comma" : "point") + "; leave the cell blank where nothing was measured";
}

DecimalSigns possible_decimal_signs(std::string_view cell) {
  return {parse_cell(cell, '.').has_value(), parse_cell(cell, ',').has_value()};
}

}  // namespace recald::table
