#include "adapters/table/cells/cell_number.hpp"

#include <algorithm>

#include "adapters/csv/fields.hpp"
#include "adapters/table/cells/words.hpp"

namespace recald::table {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Bytes of a thousands separator at the front of `text`; 0: there is none.
std::size_t group_sign(std::string_view text, char decimal) {
  if (text.front() == ' ' || text.front() == '\'') return 1;
  if (text.front() == (decimal == ',' ? '.' : ',')) return 1;
  if (static_cast<unsigned char>(text.front()) < 0x80) return 0;
  std::string_view rest = text;
  const std::uint32_t point = take_character(rest);
  const bool is_sign = is_wide_blank(point) || point == 0x2019;
  return is_sign ? text.size() - rest.size() : 0;
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
  const bool has_sign = cell.front() == '-' || cell.front() == '+' || cell.front() == '.';
  const char first = has_sign && cell.size() > 1 ? cell[1] : cell.front();
  return !is_digit(first) && is_word_for_nothing(cell);
}

std::optional<double> parse_cell(std::string_view cell, char decimal) {
  double value = 0.0;
  if (decimal == '.' && !cell.empty() && csv::parse_plain_decimal(cell, value) == cell.size()) {
    return value;
  }
  constexpr std::string_view kMinus = "\xE2\x88\x92";
  if (cell.size() > kMinus.size() && cell.substr(0, kMinus.size()) == kMinus &&
      is_digit(cell[kMinus.size()])) {
    const auto positive = parse_cell(cell.substr(kMinus.size()), decimal);
    return positive ? std::optional{-*positive} : std::nullopt;
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
  const char other = decimal == ',' ? '.' : ',';
  const auto words = [](char sign) { return sign == ',' ? "comma" : "point"; };
  std::string problem = csv::in_quotes(cell) + " is no number with a decimal " + words(decimal);
  if (parse_cell(cell, other)) return problem + "; it is one with a decimal " + words(other);
  return problem + "; leave the cell blank where nothing was measured";
}

DecimalSigns possible_decimal_signs(std::string_view cell) {
  return {parse_cell(cell, '.').has_value(), parse_cell(cell, ',').has_value()};
}

NumberAndUnit split_number(std::string_view cell) {
  std::string_view rest = cell;
  std::size_t end = 0;  // behind the last figure
  while (!rest.empty()) {
    const std::size_t at = cell.size() - rest.size();
    const char c = rest.front();
    if (is_digit(c)) end = at + 1;
    const bool is_exponent = (c == 'e' || c == 'E') && end == at && at > 0 && rest.size() > 1 &&
                             (is_digit(rest[1]) || rest[1] == '-' || rest[1] == '+');
    const std::uint32_t point = take_character(rest);
    const bool is_sign = point == '.' || point == ',' || point == ' ' || point == '\'' ||
                         point == 0x2019 || is_wide_blank(point);
    const bool is_front_sign = at == 0 && (point == '-' || point == '+');
    const bool is_after_exponent =
        at > 0 && (cell[at - 1] == 'e' || cell[at - 1] == 'E') && (point == '-' || point == '+');
    if (!is_digit(c) && !is_sign && !is_front_sign && !is_exponent && !is_after_exponent) break;
  }
  std::string_view unit = cell.substr(end);
  for (std::string_view left = unit; !left.empty(); unit = left) {
    const std::uint32_t point = take_character(left);
    if (point != ' ' && point != '.' && !is_wide_blank(point)) break;
  }
  return {cell.substr(0, end), csv::trimmed(unit)};
}

}  // namespace recald::table
