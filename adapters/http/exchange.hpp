/// Between Beast's messages and ours: what a session needs that has nothing to do with streams.
///
/// Internal to this folder: Beast shows here.
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

#include "adapters/http/ascii.hpp"
#include "adapters/http/dress.hpp"
#include "adapters/http/message.hpp"
#include "core/result.hpp"

namespace recald::http {

/// What a server asks of every session.
struct SessionRules {
  std::string token;                 ///< Empty: none is asked for.
  std::set<std::string> open_paths;  ///< Answered without the token.
  std::size_t body_max = 1024 * 1024;
  std::size_t header_max = 16 * 1024;
  std::chrono::milliseconds slow_client{10'000};
  bool is_stopping = false;
};

/// Method, target and headers. @return or malformed, see parse_target.
[[nodiscard]] Result<Request> request_head(
    const boost::beast::http::request<boost::beast::http::string_body>& message);

/// What is refused before the body is read: no token, or a POST that a web page of any origin could
/// make a browser send (a body that does not call itself JSON).
[[nodiscard]] std::optional<Response> refusal_of_head(const Request& request,
                                                      const SessionRules& rules);

/// What a failed read says to the client; nothing where it went away or was too slow.
[[nodiscard]] std::optional<Response> refusal_of(const boost::system::error_code& error);

[[nodiscard]] Response bad_request(const Error& error);

/// The handler's answer; a 500 without details if it throws.
[[nodiscard]] Response called(const Handler& handler, const Request& request);

[[nodiscard]] boost::beast::http::response<boost::beast::http::string_body> wire_message(
    const Response& response, bool keep_alive);
/// The answer to HEAD: the length that the body would have, and no body.
[[nodiscard]] boost::beast::http::response<boost::beast::http::empty_body> wire_head(
    const Response& response, bool keep_alive);

}  // namespace recald::http
