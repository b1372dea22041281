#include "core/text/printable.hpp"

namespace recald {
namespace {

constexpr std::string_view kHexDigits = "0123456789ABCDEF";

bool is_control(unsigned char c) { return c < 0x20 || c == 0x7F; }

}  // namespace

std::string printable(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (!is_control(byte)) {
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
