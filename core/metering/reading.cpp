#include "core/metering/reading.hpp"

#include <array>
#include <cassert>

namespace recald::metering {
namespace {

constexpr std::array<std::string_view, 6> kUtilities{"electricity", "chilled_water", "heating",
                                                     "steam",       "gas",           "water"};

constexpr std::array<std::string_view, 5> kValidities{"ok", "missing", "filled", "scaled",
                                                      "suspect"};

// In order of the bits. The strings are stable: exports and other programs use them.
constexpr std::array<std::string_view, 23> kReasons{
    "timeout", "exception", "crc",      "mismatch",  "sentinel", "nan",    "range",    "spike",
    "stuck",   "negative",  "zero_run", "sum_check", "rollover", "wrap",   "reset",    "jump",
    "bounce",  "clock",     "partial",  "coarse",    "replay",   "manual", "estimated"};

}  // namespace

std::string_view to_string(Utility utility) {
  return kUtilities.at(static_cast<std::size_t>(utility));
}

Result<Utility> parse_utility(std::string_view text) {
  for (std::size_t i = 0; i < kUtilities.size(); ++i) {
    if (text == kUtilities[i]) return static_cast<Utility>(i);
  }
  return failure(
      ErrorCode::invalid_value,
      "'" + std::string{text} +
          "' is not a utility; use electricity, chilled_water, heating, steam, gas or water");
}

std::string_view to_string(Validity validity) {
  return kValidities.at(static_cast<std::size_t>(validity));
}

Result<Validity> parse_validity(std::string_view text) {
  for (std::size_t i = 0; i < kValidities.size(); ++i) {
    if (text == kValidities[i]) return static_cast<Validity>(i);
  }
  return failure(
      ErrorCode::invalid_value,
      "'" + std::string{text} + "' is not a validity; use ok, missing, filled, scaled or suspect");
}

std::string to_string(Reason reasons) {
  std::string text;
  for (std::size_t bit = 0; bit < kReasons.size(); ++bit) {
    if (!has(reasons, static_cast<Reason>(1u << bit))) continue;
    if (!text.empty()) text += '|';
    text += kReasons[bit];
  }
  return text;
}

Result<Reason> parse_reasons(std::string_view text) {
  Reason reasons = Reason::none;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find('|'));
    text.remove_prefix(word.size() < text.size() ? word.size() + 1 : word.size());
    std::size_t bit = 0;
    while (bit < kReasons.size() && kReasons[bit] != word) ++bit;
    if (bit == kReasons.size()) {
      return failure(ErrorCode::invalid_value, "'" + std::string{word} + "' is not a known reason");
    }
    reasons |= static_cast<Reason>(1u << bit);
  }
  return reasons;
}

}  // namespace recald::metering
