/// What every answer gets, whoever made it: the client's cached copy confirmed, gzip, and the
/// headers that keep browsers from doing harm.
#pragma once

#include <string>
#include <string_view>

#include "adapters/http/message.hpp"

namespace recald::http {

/// W/"…" of the body's digest. Weak, because the same body may go out packed or not.
[[nodiscard]] std::string etag_of(std::string_view body);

/// Whether an If-None-Match header names the tag, by weak comparison, or any ("*").
[[nodiscard]] bool matches_etag(std::string_view if_none_match, std::string_view etag);

/// - 200 on GET or HEAD: an ETag; 304 without a body where the client has that body already.
/// - Bodies of 1 KiB and more are packed for those who accept gzip.
/// - Content-Security-Policy, no sniffing of types, no framing, no shared caches.
[[nodiscard]] Response dressed(const Request& request, Response response);

}  // namespace recald::http
