/// UTF-8, and text that older programs write instead.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace recald {

/// As in Unicode: no overlong forms, no surrogates, nothing above U+10FFFF.
[[nodiscard]] bool is_utf8(std::string_view text);

/// @pre `point` is at most U+10FFFF.
void append_utf8(std::string& out, std::uint32_t point);

/// Text that is not UTF-8 is taken for Windows-1252, in which older programs write "m³", "°C" and
/// dashes, or, if its words need it, for Windows-1250 of Central Europe.
[[nodiscard]] std::string utf8_of(std::string_view text);

}  // namespace recald
