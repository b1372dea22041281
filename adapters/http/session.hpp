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
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <chrono>
#include <cstdint>
#include <optional>

#include "adapters/http/exchange.hpp"
#include "adapters/http/turns.hpp"

namespace recald::http {

/// From now on, all reads and writes on the stream share this much time. Streams without deadlines
/// (in tests) have no limit.
template <class Stream>
void set_deadline(Stream& stream, std::chrono::milliseconds length) {
  if constexpr (requires { boost::beast::get_lowest_layer(stream).expires_after(length); }) {
    boost::beast::get_lowest_layer(stream).expires_after(length);
  }
}

/// What a session waits for: nothing else takes its time, as the handler answers at once.
struct Waiting {
  /// The first are the first to be closed when there are too many.
  enum class For : std::uint8_t {
    leave,     ///< It has had its last response.
    request,   ///< Or the rest of its head.
    body,      ///< The rest of it.
    response,  ///< Its turn, or that the client receives it.
  };
  For what = For::request;
  std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();
};

template <class Stream>
class Session {
 public:
  /// @param rules, handler  Outlive the session; may change between two requests.
  /// @param turns           Of all sessions; outlives this one.
  Session(Stream& stream, const SessionRules& rules, const Handler& handler, Turns& turns)
      : stream_(stream), rules_(rules), handler_(handler), turns_(turns) {}

  [[nodiscard]] const Waiting& waiting() const { return waiting_; }

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
    bool is_folded = false;
    wait_for(Waiting::For::request);
    co_await read_head(parser, is_folded, error);
    Result<Request> request;
    std::optional<Response> refusal;
    if (error) {
      refusal = refusal_of(error);
    } else if (is_folded) {
      refusal = bad_request({ErrorCode::malformed, "a header goes on in the next line"});
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
    wait_for(Waiting::For::response);
    const auto make_answer = [&] { return dressed(*request, called(handler_, *request)); };
    Response answer;
    if (rules_.prompt_paths.contains(request->path)) {
      answer = make_answer();
    } else {
      Turns::Turn turn{turns_, stream_.get_executor()};
      co_await turn.come();
      if (rules_.is_stopping) co_return false;  // the handler's owner may be gone
      if (rules_.worker == nullptr) {
        answer = turn.make(make_answer);
      } else {
        co_await elsewhere(*rules_.worker, [&] { answer = make_answer(); });
      }
    }
    if (rules_.is_stopping) co_return false;
    const Response response = readable_by_origin(*request, rules_, std::move(answer));
    set_deadline(stream_, rules_.slow_client);
    const bool sent = co_await send(method, response, keep_alive);
    if (sent && !keep_alive) co_await part(true);
    co_return sent&& keep_alive;
  }

  void wait_for(Waiting::For what) { waiting_ = {what, std::chrono::steady_clock::now()}; }

  /// The parser takes a head as a whole, so that its bytes can be looked at before.
  /// @param is_folded  Whether a line of it goes on in the next.
  boost::asio::awaitable<void> read_head(Parser& parser, bool& is_folded, Error& error) {
    for (;;) {
      if (buffer_.size() > 0) {
        const auto bytes = buffer_.data();
        is_folded = has_folded_line({static_cast<const char*>(bytes.data()), bytes.size()});
        buffer_.consume(parser.put(bytes, error));
        if (error != boost::beast::http::error::need_more) co_return;
        error = {};
      }
      constexpr std::size_t kAtATime = 4096;
      const std::size_t read =
          co_await stream_.async_read_some(buffer_.prepare(kAtATime), into(error));
      if (error) co_return;
      buffer_.commit(read);
    }
  }

  boost::asio::awaitable<void> read_body(const Request& request, Parser& parser, Error& error) {
    if (equals_ignoring_case(request.header("expect"), "100-continue")) {
      co_await send_continue(error);
    }
    wait_for(Waiting::For::body);
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
    wait_for(Waiting::For::response);
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
    wait_for(Waiting::For::leave);
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
  Turns& turns_;
  Waiting waiting_;
  boost::beast::flat_buffer buffer_;
};

}  // namespace recald::http
