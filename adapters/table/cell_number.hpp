/// Numbers as other programs write them: decimal commas, thousands separators,
/// words for "no value".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace recald::table {

/// Whether a cell holds no measurement: blank, "-", "n/a", "NaN", "null" and the like.
[[nodiscard]] bool is_blank(std::string_view cell);

/// A finite number with this decimal sign, '.' or ','. Groups of three digits may be separated by
/// the other of the two, a space or an apostrophe. Otherwise nothing.
[[nodiscard]] std::optional<double> parse_cell(std::string_view cell, char decimal);

/// Says why `parse_cell` refused a cell: "'1.234,5' is no number with a decimal point".
[[nodiscard]] std::string cell_problem(std::string_view cell, char decimal);

/// The decimal signs that a cell allows: a point, a comma, or both ("1,234").
struct DecimalSigns {
  bool point;
  bool comma;
};
[[nodiscard]] DecimalSigns possible_decimal_signs(std::string_view cell);

}  // namespace recald::table
