/// Numbers for the page's script.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace recald::report {

/// The number with so many significant digits, or null where it is not finite. Keeps the page
/// small: the shortest text of a rounded double is short.
[[nodiscard]] nlohmann::json json_number(double value, int significant_digits = 6);

/// Every element of a range by `json_number`.
template <class Range>
[[nodiscard]] nlohmann::json json_numbers(const Range& values, int significant_digits = 6) {
  nlohmann::json array = nlohmann::json::array();
  for (const double value : values) array.push_back(json_number(value, significant_digits));
  return array;
}

/// Compact JSON in which no "<" occurs, so that no text can close the surrounding script tag. Bytes
/// that are not UTF-8 (a name from an old file) become U+FFFD.
[[nodiscard]] std::string script_safe_text(const nlohmann::json& json);

}  // namespace recald::report
