/// Texts of others inside sentences for people.
#pragma once

#include <string>
#include <string_view>

namespace recald {

/// The text with its control characters written out, "\x1B" for an escape: what somebody's file
/// contains must neither move the cursor nor begin a line of its own in a log.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace recald
