#include "core/text/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace recald {
namespace {

std::string to_text(double value, std::chars_format format, int precision) {
  // The longest is DBL_MAX in fixed notation: 309 digits, sign, point and decimals.
  std::array<char, 384> buffer;
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format, precision);
  return {buffer.data(), end.ptr};
}

}  // namespace

std::string number_text(double value, int digits) {
  return to_text(value, std::chars_format::general, digits);
}

std::string percent_text(double share) {
  return to_text(100.0 * share, std::chars_format::fixed, 1) + " %";
}

std::string signed_percent_text(double share) {
  const int decimals = std::abs(share) < 0.01 ? 1 : 0;
  return (share < 0.0 ? "" : "+") + to_text(100.0 * share, std::chars_format::fixed, decimals) +
         " %";
}

}  // namespace recald
