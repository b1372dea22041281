/// Numbers as other programs write them: decimal commas, thousands separators, units behind them,
/// words for "no value".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace recald::table {

/// Whether a cell holds no measurement: blank, or a word for nothing. @see is_word_for_nothing
[[nodiscard]] bool is_blank(std::string_view cell);

/// A finite number with this decimal sign, '.' or ','. Groups of three digits may be separated by
/// the other of the two, a blank of any width or an apostrophe. Otherwise nothing.
[[nodiscard]] std::optional<double> parse_cell(std::string_view cell, char decimal);

/// Says why `parse_cell` refused a cell, and what would do: "'1.234,5' is no number with a decimal
/// point; it is one with a decimal comma".
[[nodiscard]] std::string cell_problem(std::string_view cell, char decimal);

/// The decimal signs that a cell allows: a point, a comma, or both ("1,234").
struct DecimalSigns {
  bool point;
  bool comma;
};
[[nodiscard]] DecimalSigns possible_decimal_signs(std::string_view cell);

/// "12.3 kWh", "1 234 Wh", "="12,3"": the number and the letters behind it, which may be none.
/// @return views of the cell, without blanks at their ends; an empty number if the cell does not
///         begin with a figure or a sign.
struct NumberAndUnit {
  std::string_view number;
  std::string_view unit;
};
[[nodiscard]] NumberAndUnit split_number(std::string_view cell);

}  // namespace recald::table
