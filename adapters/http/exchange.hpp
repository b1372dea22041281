/// Translates between Beast's messages and ours: the parts of a session that need no stream.
///
/// Internal to this folder, because it exposes Beast.
#pragma once

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/system/error_code.hpp>
#include <chrono>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "adapters/http/access.hpp"
#include "adapters/http/ascii.hpp"
#include "adapters/http/dress.hpp"
#include "adapters/http/message.hpp"
#include "adapters/ports/worker.hpp"
#include "core/result.hpp"

namespace recald::http {

/// The settings that all sessions of a server share.
struct SessionRules {
  AccessRules access;
  std::set<std::string> prompt_paths;  ///< Answered at once, not in turn.
  Worker* worker = nullptr;            ///< Makes the other answers; null: the loop's own thread.
  std::set<std::string>
      origins;  ///< Whose pages may ask from a browser: "https://bms.example.org".
  std::size_t body_max = 1024 * 1024;
  std::size_t header_max = 16 * 1024;
  std::chrono::milliseconds slow_client{10'000};
  bool is_stopping = false;
};

/// Method, target and headers. @return or malformed: see parse_target; no or several `Host`; an
/// encoding that leaves the length of the body open to interpretation (RFC 9112, 6.3).
[[nodiscard]] Result<Request> request_head(
    const boost::beast::http::request<boost::beast::http::string_body>& message);

/// The answer to a browser that asks first whether a page of another origin may send a request
/// (Fetch standard, CORS preflight). Nothing if this is no such question, or of an origin that may
/// not: then it is answered like anything else, and the browser does not send the request.
[[nodiscard]] std::optional<Response> preflight_answer(const Request& request,
                                                       const SessionRules& rules);

/// Lets pages of an allowed origin read the response.
[[nodiscard]] Response readable_by_origin(const Request& request, const SessionRules& rules,
                                          Response response);

/// What is refused before the body is read: a missing token, or a POST that any web page could make
/// a browser send (its body is not declared as JSON).
[[nodiscard]] std::optional<Response> refusal_of_head(const Request& request,
                                                      const SessionRules& rules);

/// Whether a header's value goes on in the next line (RFC 9112, 5.2), which programs on the way may
/// read as something else.
/// @param bytes  From the request's first on.
[[nodiscard]] bool has_folded_line(std::string_view bytes);

/// The response to a failed read; nothing if the client went away or was too slow.
[[nodiscard]] std::optional<Response> refusal_of(const boost::system::error_code& error);

[[nodiscard]] Response bad_request(const Error& error);

/// The handler's response; a 500 without details if it throws.
[[nodiscard]] Response called(const Handler& handler, const Request& request);

[[nodiscard]] boost::beast::http::response<boost::beast::http::string_body> wire_message(
    const Response& response, bool keep_alive);
/// The response to HEAD: the length that the body would have, and no body.
[[nodiscard]] boost::beast::http::response<boost::beast::http::empty_body> wire_head(
    const Response& response, bool keep_alive);

}  // namespace recald::http
