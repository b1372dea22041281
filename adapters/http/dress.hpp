/// What every response gets: the check of the client's cached copy, gzip, and protective headers.
#pragma once

#include <string>
#include <string_view>

#include "adapters/http/message.hpp"

namespace recald::http {

/// W/"…" with the body's digest. Weak, because the same body may be sent compressed or not.
[[nodiscard]] std::string etag_of(std::string_view body);

/// Whether an If-None-Match header names the tag, by weak comparison, or is "*".
[[nodiscard]] bool matches_etag(std::string_view if_none_match, std::string_view etag);

/// - 200 on GET or HEAD: an ETag; 304 without a body if the client already has that body.
/// - Bodies of 1 KiB and more are compressed for clients that accept gzip.
/// - Content-Security-Policy, no sniffing of types, no framing, no shared caches.
[[nodiscard]] Response dressed(const Request& request, Response response);

/// What the server itself refuses: the handler does not see it, so its headers are added here.
[[nodiscard]] inline Response refused(int status, std::string_view code, std::string_view message) {
  return dressed({}, error_response(status, code, message));
}

}  // namespace recald::http
