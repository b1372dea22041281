/// Bodies made small for clients that say they can read them.
#pragma once

#include <string>
#include <string_view>

namespace recald::http {

/// Whether an Accept-Encoding header lets gzip through: "gzip", "x-gzip" or "*" with a weight that
/// is not zero; what is named beats "*".
[[nodiscard]] bool accepts_gzip(std::string_view accept_encoding);

/// RFC 1952, at zlib's fastest level: the event loop waits for it.
[[nodiscard]] std::string gzip(std::string_view text);

}  // namespace recald::http
