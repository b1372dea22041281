/// Texts of others that would be too long to keep.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace recald {

/// The text, or its beginning with what is missing: "timeout on line 7 … (186015 bytes in all)",
/// cut between two characters.
/// @param bytes_max  Of the result, at least 40.
[[nodiscard]] inline std::string limited(std::string_view text, std::size_t bytes_max) {
  if (text.size() <= bytes_max) return std::string{text};
  const std::string rest = " \u2026 (" + std::to_string(text.size()) + " bytes in all)";
  std::size_t end = bytes_max - rest.size();
  const auto continues = [&](std::size_t at) {
    return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
  };
  while (end > 0 && continues(end)) --end;
  return std::string{text.substr(0, end)} + rest;
}

}  // namespace recald
