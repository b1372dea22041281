/// Texts of others inside sentences for people.
#pragma once

#include <string>
#include <string_view>

namespace recald {

/// The text with what is no character to be seen written out, "\x1B" for an escape, "\u202E" for
/// what turns the direction of writing: what somebody's file contains must neither move the cursor
/// nor begin a line of its own in a log.
/// @param kept  Control characters that stay: "\n\t" of a text with lines.
[[nodiscard]] std::string printable(std::string_view text, std::string_view kept = {});

}  // namespace recald
