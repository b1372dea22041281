#include "core/text/utf8.hpp"

#include <array>

namespace recald {
namespace {

/// Length in bytes of the UTF-8 sequence that starts with `lead`; 0 if none does.
std::size_t sequence_length(unsigned char lead) {
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead < 0xE0) return 2;
  if (lead >= 0xE0 && lead < 0xF0) return 3;
  if (lead >= 0xF0 && lead < 0xF5) return 4;
  return 0;
}

/// The characters of the upper half.
using CodePage = std::array<std::uint16_t, 128>;

constexpr CodePage make_windows1252() {
  // Windows has other signs where Latin-1 has none: dashes, quotes, the euro.
  constexpr std::array<std::uint16_t, 32> kSigns{
      0x20AC, 0x81,   0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
      0x2039, 0x0152, 0x8D,   0x017D, 0x8F,   0x90,   0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
      0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0x9D,   0x017E, 0x0178};
  CodePage page{};
  for (std::size_t i = 0; i < page.size(); ++i) {
    page[i] = i < kSigns.size() ? kSigns[i] : static_cast<std::uint16_t>(0x80 + i);
  }
  return page;
}
constexpr CodePage kWindows1252 = make_windows1252();
constexpr CodePage kWindows1250{
    0x20AC, 0x81,   0x201A, 0x83,   0x201E, 0x2026, 0x2020, 0x2021, 0x88,   0x2030, 0x0160, 0x2039,
    0x015A, 0x0164, 0x017D, 0x0179, 0x90,   0x2018, 0x2019, 0x201C, 0x201D, 0x2022, 0x2013, 0x2014,
    0x98,   0x2122, 0x0161, 0x203A, 0x015B, 0x0165, 0x017E, 0x017A, 0xA0,   0x02C7, 0x02D8, 0x0141,
    0xA4,   0x0104, 0xA6,   0xA7,   0xA8,   0xA9,   0x015E, 0xAB,   0xAC,   0xAD,   0xAE,   0x017B,
    0xB0,   0xB1,   0x02DB, 0x0142, 0xB4,   0xB5,   0xB6,   0xB7,   0xB8,   0x0105, 0x015F, 0xBB,
    0x013D, 0x02DD, 0x013E, 0x017C, 0x0154, 0xC1,   0xC2,   0x0102, 0xC4,   0x0139, 0x0106, 0xC7,
    0x010C, 0xC9,   0x0118, 0xCB,   0x011A, 0xCD,   0xCE,   0x010E, 0x0110, 0x0143, 0x0147, 0xD3,
    0xD4,   0x0150, 0xD6,   0xD7,   0x0158, 0x016E, 0xDA,   0x0170, 0xDC,   0xDD,   0x0162, 0xDF,
    0x0155, 0xE1,   0xE2,   0x0103, 0xE4,   0x013A, 0x0107, 0xE7,   0x010D, 0xE9,   0x0119, 0xEB,
    0x011B, 0xED,   0xEE,   0x010F, 0x0111, 0x0144, 0x0148, 0xF3,   0xF4,   0x0151, 0xF6,   0xF7,
    0x0159, 0x016F, 0xFA,   0x0171, 0xFC,   0xFD,   0x0163, 0x02D9};

/// Whether signs of Western Europe stand within words, as "³", "¹" and "¿" do in "Ciep³o", "Pr¹d"
/// and "Zu¿ycie": then they are the letters that Central Europe has there. "m³" is a unit.
bool is_central_european(std::string_view text) {
  const auto is_letter = [&](std::size_t i) {
    const auto byte = i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
    return (byte >= 'A' && byte <= 'Z') || (byte >= 'a' && byte <= 'z') || byte >= 0xC0;
  };
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte != 0xB3 && byte != 0xB9 && byte != 0xBF) continue;
    const bool is_of_metre = text[i - 1] == 'm' && (i < 2 || !is_letter(i - 2));
    if (is_letter(i - 1) && is_letter(i + 1) && !is_of_metre) return true;
  }
  return false;
}

}  // namespace

bool is_utf8(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = sequence_length(byte(i));
    if (length == 0 || length > text.size() - i) return false;
    for (std::size_t k = 1; k < length; ++k) {
      if ((byte(i + k) & 0xC0) != 0x80) return false;
    }
    if (byte(i) == 0xE0 && byte(i + 1) < 0xA0) return false;
    if (byte(i) == 0xED && byte(i + 1) >= 0xA0) return false;
    if (byte(i) == 0xF0 && byte(i + 1) < 0x90) return false;
    if (byte(i) == 0xF4 && byte(i + 1) >= 0x90) return false;
    i += length;
  }
  return true;
}

void append_utf8(std::string& out, std::uint32_t point) {
  const auto byte = [&](std::uint32_t bits) { out += static_cast<char>(bits); };
  if (point < 0x80) {
    byte(point);
  } else if (point < 0x800) {
    byte(0xC0 | (point >> 6));
    byte(0x80 | (point & 0x3F));
  } else if (point < 0x10000) {
    byte(0xE0 | (point >> 12));
    byte(0x80 | ((point >> 6) & 0x3F));
    byte(0x80 | (point & 0x3F));
  } else {
    byte(0xF0 | (point >> 18));
    byte(0x80 | ((point >> 12) & 0x3F));
    byte(0x80 | ((point >> 6) & 0x3F));
    byte(0x80 | (point & 0x3F));
  }
}

std::string utf8_of(std::string_view text) {
  if (is_utf8(text)) return std::string{text};
  const CodePage& page = is_central_european(text) ? kWindows1250 : kWindows1252;
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    append_utf8(out, byte < 0x80 ? byte : page[byte - 0x80u]);
  }
  return out;
}

}  // namespace recald
