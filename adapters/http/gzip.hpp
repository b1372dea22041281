/// Compressed bodies for clients that accept them.
#pragma once

#include <string>
#include <string_view>

namespace recald::http {

/// Whether an Accept-Encoding header allows gzip: "gzip", "x-gzip" or "*" with a weight that is not
/// zero. A named encoding takes precedence over "*".
[[nodiscard]] bool accepts_gzip(std::string_view accept_encoding);

/// RFC 1952, at zlib's fastest level because the event loop waits for it.
[[nodiscard]] std::string gzip(std::string_view text);

}  // namespace recald::http
