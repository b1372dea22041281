/// The parts of a CSV line: fields, numbers, time stamps. None depends on the process locale.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::csv {

/// Splits lines by RFC 4180 without allocating; only quoted fields are copied.
class FieldSplitter {
 public:
  static constexpr std::size_t kFieldsMax = 64;

  /// @return the number of fields; kFieldsMax + 1 if there are more, 0 if a quote stays open.
  std::size_t split(std::string_view line);

  [[nodiscard]] std::string_view operator[](std::size_t field) const { return fields_[field]; }

 private:
  std::size_t split_quoted(std::string_view line);

  std::array<std::string_view, kFieldsMax> fields_;
  std::string unquoted_;  ///< Contents of quoted fields, reused from line to line.
};

/// The text without surrounding spaces and tabs.
[[nodiscard]] inline std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

/// 'text' for a message; control characters are escaped.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// The finite decimal number, with a dot, that fills the whole text; nothing otherwise.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// Reads a plain decimal such as -123.456, without exponent, from the front of `text`. Up to 15
/// digits are an exact integer in a double, and so is 10^15, so their quotient is the correctly
/// rounded value: the same as from_chars gives, in a third of the time.
/// @return the number of characters read; 0 when `parse_number` should read it instead.
/// @see Clinger (1990), How to read floating point numbers accurately, PLDI.
std::size_t parse_plain_decimal(std::string_view text, double& value);

/// Says why `parse_number` refused a text: "value '12,5' has a decimal comma; write 12.5".
[[nodiscard]] std::string number_problem(std::string_view name, std::string_view text);

/// Whether the text is digits only, like each half of a number split at a decimal comma.
[[nodiscard]] bool is_digits(std::string_view text);

/// ISO 8601 with Z or an offset: 2016-03-13T02:15:00-06:00. Seconds may be absent, a space may
/// replace the T, 24:00 is the end of the day. @return malformed or out_of_range (outside
/// the known years).
[[nodiscard]] Result<metering::Instant> parse_timestamp(std::string_view text);

}  // namespace recald::csv
