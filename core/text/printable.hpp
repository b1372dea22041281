/// Texts of others inside sentences for people.
#pragma once

#include <string>
#include <string_view>

namespace recald {

/// The text with its control characters written out, "\x1B" for an escape: what somebody's file
/// contains must neither move the cursor nor begin a line of its own in a log.
[[nodiscard]] inline std::string printable(std::string_view text) {
  constexpr std::string_view kHexDigits = "0123456789ABCDEF";
  std::string shown;
  shown.reserve(text.size());
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7F) {
      shown += c;
      continue;
    }
    shown += "\\x";
    shown += kHexDigits[byte >> 4];
    shown += kHexDigits[byte & 0xF];
  }
  return shown;
}

}  // namespace recald
