#include "adapters/http/client.hpp"

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <exception>
#include <optional>

namespace recald::http {
namespace {

namespace beast = boost::beast;
using boost::asio::awaitable;
using boost::asio::ip::tcp;
using ErrorText = boost::system::error_code;

auto into(ErrorText& error) {
  return boost::asio::redirect_error(boost::asio::use_awaitable, error);
}

auto broken(const Url& url, const ErrorText& error) {
  return failure(ErrorCode::io_failed, "asking " + url.text() + " failed: " + error.message());
}

template <class Stream>
awaitable<Result<Response>> exchange(Stream& stream, const Url& url, const ClientOptions& options) {
  beast::http::request<beast::http::empty_body> request{beast::http::verb::get, url.path, 11};
  request.set(beast::http::field::host, url.authority());
  request.set(beast::http::field::user_agent, "recald");
  request.keep_alive(false);
  if (!options.token.empty()) {
    request.set(beast::http::field::authorization, "Bearer " + options.token);
  }
  ErrorText error;
  co_await beast::http::async_write(stream, request, into(error));
  if (error) co_return broken(url, error);

  beast::flat_buffer buffer;
  beast::http::response_parser<beast::http::string_body> parser;
  parser.body_limit(options.body_max);
  co_await beast::http::async_read(stream, buffer, parser, into(error));
  if (error) co_return broken(url, error);
  Response response{.status = static_cast<int>(parser.get().result_int()),
                    .body = std::move(parser.get().body())};
  for (const auto& field : parser.get()) {
    response.headers.emplace_back(std::string{field.name_string()}, std::string{field.value()});
  }
  response.content_type = response.header("Content-Type");
  co_return response;
}

Result<void> set_trust(boost::asio::ssl::context& tls, const ClientOptions& options) {
  ErrorText error;
  tls.set_verify_mode(boost::asio::ssl::verify_peer);
  if (options.trusted_certificate.empty()) {
    tls.set_default_verify_paths(error);
  } else {
    tls.load_verify_file(options.trusted_certificate.string(), error);
  }
  if (!error) return {};
  return failure(ErrorCode::io_failed, "certificate '" + options.trusted_certificate.string() +
                                           "' cannot be used: " + error.message());
}

awaitable<Result<Response>> exchange_over_tls(beast::tcp_stream& connected, const Url& url,
                                              const ClientOptions& options) {
  boost::asio::ssl::context tls{boost::asio::ssl::context::tls_client};
  if (auto trusted = set_trust(tls, options); !trusted) co_return tl::unexpected(trusted.error());
  beast::ssl_stream<beast::tcp_stream> stream{std::move(connected), tls};
  if (options.trusted_certificate.empty()) {
    stream.set_verify_callback(boost::asio::ssl::host_name_verification{url.host});
    SSL_set_tlsext_host_name(stream.native_handle(), url.host.c_str());
  }
  ErrorText error;
  co_await stream.async_handshake(boost::asio::ssl::stream_base::client, into(error));
  if (error) co_return broken(url, error);
  // How the connection ends does not matter: the response stated its length.
  co_return co_await exchange(stream, url, options);
}

awaitable<Result<Response>> ask(const Url& url, const ClientOptions& options) {
  const auto executor = co_await boost::asio::this_coro::executor;
  ErrorText error;
  tcp::resolver resolver{executor};
  const auto found =
      co_await resolver.async_resolve(url.host, std::to_string(url.port), into(error));
  beast::tcp_stream stream{executor};
  stream.expires_after(options.timeout);
  if (!error) co_await stream.async_connect(found, into(error));
  if (error) {
    co_return failure(ErrorCode::not_found,
                      "nothing answers at " + url.text() + ": " + error.message());
  }
  if (url.is_tls) co_return co_await exchange_over_tls(stream, url, options);
  co_return co_await exchange(stream, url, options);
}

}  // namespace

Result<Response> get(const Url& url, const ClientOptions& options) {
  boost::asio::io_context context{1};
  std::optional<Result<Response>> answer;
  std::exception_ptr thrown;
  boost::asio::co_spawn(context, ask(url, options),
                        [&](std::exception_ptr exception, Result<Response> result) {
                          thrown = exception;
                          answer = std::move(result);
                        });
  context.run();
  if (thrown || !answer) {
    return failure(ErrorCode::io_failed, "asking " + url.text() + " failed");
  }
  return *std::move(answer);
}

}  // namespace recald::http
