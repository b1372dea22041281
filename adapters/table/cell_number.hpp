/// Numbers as people's programs write them: a decimal comma, thousands apart, a word for nothing.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace recald::table {

/// Nothing was measured: blank, "-", "n/a", "NaN", "null" and the like.
[[nodiscard]] bool is_blank(std::string_view cell);

/// A finite number with this decimal sign, '.' or ','; thousands may be set apart, in threes, by
/// the other of the two, a blank or an apostrophe. None otherwise.
[[nodiscard]] std::optional<double> parse_cell(std::string_view cell, char decimal);

/// What is wrong with a cell that `parse_cell` refuses: "'1.234,5' is no number with a decimal
/// point".
[[nodiscard]] std::string cell_problem(std::string_view cell, char decimal);

/// Which decimal sign a cell shows: it can be a point, or a comma, or both ("1,234").
struct DecimalSigns {
  bool point;
  bool comma;
};
[[nodiscard]] DecimalSigns possible_decimal_signs(std::string_view cell);

}  // namespace recald::table
