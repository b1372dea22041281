/// Numbers for the page's script.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace recald::views {

/// The number rounded to that many significant digits, or null if it is not finite. Rounding
/// shortens the text and keeps the page small.
[[nodiscard]] nlohmann::json json_number(double value, int significant_digits = 6);

/// Applies `json_number` to each element of a range.
template <class Range>
[[nodiscard]] nlohmann::json json_numbers(const Range& values, int significant_digits = 6) {
  nlohmann::json array = nlohmann::json::array();
  for (const double value : values) array.push_back(json_number(value, significant_digits));
  return array;
}

/// Compact JSON without any "<", so that no text can close the surrounding script tag. Bytes that
/// are not UTF-8 (a name from an old file) become U+FFFD.
[[nodiscard]] std::string script_safe_text(const nlohmann::json& json);

}  // namespace recald::views
