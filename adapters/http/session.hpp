/// One client's connection: handles its requests one after the other, each with a deadline.
///
/// Internal to this folder. A template, so that tests can use a stream that fails on purpose.
#pragma once

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/stream_traits.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <chrono>
#include <optional>

#include "adapters/http/exchange.hpp"

namespace recald::http {

/// From now on, all reads and writes on the stream share this much time. Streams without deadlines
/// (in tests) have no limit.
template <class Stream>
void set_deadline(Stream& stream, std::chrono::milliseconds length) {
  if constexpr (requires { boost::beast::get_lowest_layer(stream).expires_after(length); }) {
    boost::beast::get_lowest_layer(stream).expires_after(length);
  }
}

template <class Stream>
class Session {
 public:
  /// @param rules, handler  Outlive the session; may change between two requests.
  Session(Stream& stream, const SessionRules& rules, const Handler& handler)
      : stream_(stream), rules_(rules), handler_(handler) {}

  using Time = std::chrono::steady_clock::time_point;

  /// Since when the session has waited for a request or the rest of its head. Absent while a
  /// request is being answered.
  [[nodiscard]] const std::optional<Time>& waiting_since() const { return waiting_since_; }

  /// Runs until the client leaves, is too slow, asks to close, or sends something unreadable.
  boost::asio::awaitable<void> run() {
    bool goes_on = true;
    while (goes_on) goes_on = co_await answer_one();
  }

  /// Sends one response without reading the request.
  boost::asio::awaitable<void> turn_away(const Response& response) {
    co_await refuse(Method::get, response);
  }

 private:
  using Error = boost::system::error_code;
  using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;

  static auto into(Error& error) {
    return boost::asio::redirect_error(boost::asio::use_awaitable, error);
  }

  /// @return whether another request may follow.
  boost::asio::awaitable<bool> answer_one() {
    Parser parser;
    parser.header_limit(static_cast<std::uint32_t>(rules_.header_max));
    parser.body_limit(rules_.body_max);
    set_deadline(stream_, rules_.slow_client);
    Error error;
    waiting_since_ = std::chrono::steady_clock::now();
    co_await boost::beast::http::async_read_header(stream_, buffer_, parser, into(error));
    waiting_since_.reset();
    Result<Request> request;
    std::optional<Response> refusal;
    if (error) {
      refusal = refusal_of(error);
    } else if (request = request_head(parser.get()); !request) {
      refusal = bad_request(request.error());
    } else {
      refusal = preflight_answer(*request, rules_);
      if (!refusal) refusal = refusal_of_head(*request, rules_);
    }
    const Method method = request ? request->method : Method::get;
    if (!error && !refusal) {
      co_await read_body(*request, parser, error);
      if (error) refusal = refusal_of(error);
    }
    if (refusal && request) refusal = readable_by_origin(*request, rules_, std::move(*refusal));
    if (refusal) co_await refuse(method, *refusal);
    if (error || refusal || rules_.is_stopping) co_return false;  // the handler's owner may be gone

    request->body = std::move(parser.get().body());
    const bool keep_alive = parser.get().keep_alive();
    const Response response =
        readable_by_origin(*request, rules_, dressed(*request, called(handler_, *request)));
    set_deadline(stream_, rules_.slow_client);
    const bool sent = co_await send(method, response, keep_alive);
    if (sent && !keep_alive) co_await part(true);
    co_return sent&& keep_alive;
  }

  boost::asio::awaitable<void> read_body(const Request& request, Parser& parser, Error& error) {
    if (equals_ignoring_case(request.header("expect"), "100-continue")) {
      co_await send_continue(error);
    }
    if (!error) co_await boost::beast::http::async_read(stream_, buffer_, parser, into(error));
  }

  /// Responds and closes, because the bytes that follow may not be a request.
  boost::asio::awaitable<void> refuse(Method method, const Response& refusal) {
    set_deadline(stream_, rules_.slow_client);
    // Not `if (co_await …) co_await …;`: GCC 12 loses the caller's frame there, and it crashes.
    const bool sent = co_await send(method, refusal, false);
    if (sent) co_await part(false);
  }

  boost::asio::awaitable<bool> send(Method method, const Response& response, bool keep_alive) {
    Error error;
    if (method == Method::head) {
      const auto message = wire_head(response, keep_alive);
      co_await boost::beast::http::async_write(stream_, message, into(error));
    } else {
      const auto message = wire_message(response, keep_alive);
      co_await boost::beast::http::async_write(stream_, message, into(error));
    }
    co_return !error;
  }

  boost::asio::awaitable<void> send_continue(Error& error) {
    const boost::beast::http::response<boost::beast::http::empty_body> go_on{
        boost::beast::http::status::continue_, 11};
    co_await boost::beast::http::async_write(stream_, go_on, into(error));
  }

  /// Closes the connection so that the client gets our last response: closing with unread bytes
  /// would reset it. TCP can close one direction and keep reading. TLS 1.2 cannot, so there we read
  /// to the end first.
  boost::asio::awaitable<void> part(bool has_read_all) {
    Error error;
    if constexpr (requires { stream_.async_shutdown(into(error)); }) {
      if (!has_read_all) co_await read_the_rest();
      co_await stream_.async_shutdown(into(error));
    } else {
      if constexpr (requires { stream_.socket(); }) {
        stream_.socket().shutdown(boost::asio::socket_base::shutdown_send, error);
      }
      co_await read_the_rest();
    }
  }

  /// Reads until the client closes, time is up, or more has arrived than a request may have.
  boost::asio::awaitable<void> read_the_rest() {
    Error error;
    char rest[4096];
    for (std::size_t read = 0; !error && read <= 2 * rules_.body_max;) {
      read += co_await stream_.async_read_some(boost::asio::buffer(rest), into(error));
    }
  }

  Stream& stream_;
  const SessionRules& rules_;
  const Handler& handler_;
  std::optional<Time> waiting_since_ = std::chrono::steady_clock::now();
  boost::beast::flat_buffer buffer_;
};

}  // namespace recald::http
