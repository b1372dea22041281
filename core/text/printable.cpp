#include "core/text/printable.hpp"

#include <cstddef>

namespace recald {
namespace {

constexpr std::string_view kHexDigits = "0123456789ABCDEF";

void add_hex(std::string& shown, unsigned value, int digits) {
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) {
    shown += kHexDigits[(value >> static_cast<unsigned>(shift)) & 0xFU];
  }
}

bool is_control(unsigned char byte) { return byte < 0x20 || byte == 0x7F; }

/// Controls beyond ASCII, line separators, and what changes the direction of writing.
bool is_unseen(unsigned character) {
  const auto is_in = [&](unsigned first, unsigned last) {
    return character >= first && character <= last;
  };
  return is_in(0x80, 0x9F) || is_in(0x2028, 0x202E) || is_in(0x2066, 0x2069);
}

/// The character of two or three bytes that begins at `at`; 0 for anything else.
unsigned character_at(std::string_view text, std::size_t at, std::size_t& length) {
  const auto byte = [&](std::size_t i) -> unsigned {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0U;
  };
  const auto continues = [&](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
  if ((byte(0) & 0xE0U) == 0xC0U && continues(1)) {
    length = 2;
    return ((byte(0) & 0x1FU) << 6U) | (byte(1) & 0x3FU);
  }
  if ((byte(0) & 0xF0U) == 0xE0U && continues(1) && continues(2)) {
    length = 3;
    return ((byte(0) & 0x0FU) << 12U) | ((byte(1) & 0x3FU) << 6U) | (byte(2) & 0x3FU);
  }
  return 0;
}

}  // namespace

std::string printable(std::string_view text, std::string_view kept) {
  std::string shown;
  shown.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    std::size_t length = 1;
    if (is_control(byte) && kept.find(text[i]) == std::string_view::npos) {
      shown += "\\x";
      add_hex(shown, byte, 2);
    } else if (const unsigned character = character_at(text, i, length); is_unseen(character)) {
      shown += "\\u";
      add_hex(shown, character, 4);
      i += length - 1;
    } else {
      shown += text[i];
    }
  }
  return shown;
}

}  // namespace recald
