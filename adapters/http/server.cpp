#include "adapters/http/server.hpp"

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <map>
#include <optional>

#include "adapters/asio/rethrown.hpp"
#include "adapters/http/session.hpp"

namespace recald::http {
namespace {

using boost::asio::awaitable;
using boost::asio::redirect_error;
using boost::asio::use_awaitable;
using boost::asio::ip::tcp;
using boost::beast::tcp_stream;
using TlsStream = boost::beast::ssl_stream<tcp_stream>;

constexpr std::chrono::milliseconds kAfterAcceptFailed{100};
/// Who sends or receives is not closed for another client so soon.
constexpr std::chrono::milliseconds kInPeace{1'000};

/// For a client above the limit of connections.
Response too_many() {
  Response response = dressed({}, error_response(503, "too_many_connections",
                                                 "too many connections; try again in a moment"));
  response.headers.emplace_back("Retry-After", "1");
  return response;
}

Result<tcp::endpoint> endpoint_of(const ServerOptions& options) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(options.address, error);
  if (error) {
    return failure(ErrorCode::invalid_value,
                   "'" + options.address +
                       "' is no numeric address to listen on; "
                       "127.0.0.1 is this machine alone, 0.0.0.0 all its networks");
  }
  if (!address.is_loopback() && (options.access.tokens.empty() || !options.tls)) {
    return failure(ErrorCode::invalid_value,
                   "to listen on " + options.address +
                       ", which others can reach, a token and TLS are needed: token_file, "
                       "certificate and key");
  }
  return tcp::endpoint{address, options.port};
}

}  // namespace

struct Server::Shared {
  Shared(boost::asio::io_context& context, Handler given)
      : acceptor(context), handler(std::move(given)) {}

  SessionRules rules;
  int connections_max = 0;
  tcp::acceptor acceptor;
  Tls tls;  ///< For the next connection.
  Handler handler;
  Turns turns;
  std::map<tcp_stream*, const Waiting*> open;  ///< Streams of the running sessions.
};

namespace {

/// A stream that the server knows for the lifetime of its session.
template <class Shared>
class Known {
 public:
  Known(std::shared_ptr<Shared> shared, tcp_stream& stream, const Waiting& waiting)
      : shared_(std::move(shared)), stream_(stream) {
    shared_->open.emplace(&stream_, &waiting);
  }
  ~Known() { shared_->open.erase(&stream_); }
  Known(const Known&) = delete;
  Known& operator=(const Known&) = delete;

 private:
  std::shared_ptr<Shared> shared_;
  tcp_stream& stream_;
};

template <class Shared>
awaitable<void> serve_plain(std::shared_ptr<Shared> shared, tcp::socket socket, bool is_welcome) {
  tcp_stream stream{std::move(socket)};
  Session<tcp_stream> session{stream, shared->rules, shared->handler, shared->turns};
  const Known<Shared> known{shared, stream, session.waiting()};
  if (is_welcome) {
    co_await session.run();
  } else {
    const Response refusal = too_many();
    co_await session.turn_away(refusal);
  }
}

template <class Shared>
awaitable<void> serve_tls(std::shared_ptr<Shared> shared, tcp::socket socket, bool is_welcome) {
  const auto tls = shared->tls;
  TlsStream stream{std::move(socket), *tls};
  Session<TlsStream> session{stream, shared->rules, shared->handler, shared->turns};
  const Known<Shared> known{shared, boost::beast::get_lowest_layer(stream), session.waiting()};
  set_deadline(stream, shared->rules.slow_client);
  boost::system::error_code error;
  co_await stream.async_handshake(boost::asio::ssl::stream_base::server,
                                  redirect_error(use_awaitable, error));
  if (error) co_return;
  if (is_welcome) {
    co_await session.run();
  } else {
    const Response refusal = too_many();
    co_await session.turn_away(refusal);
  }
}

/// Closes the connection that has waited longest: first of those that are to leave, then of those
/// from which a request is awaited, then the others. So clients that send or read slowly, or not at
/// all, cannot shut out others, above all a supervisor's probe. One that lost its connection
/// connects again.
/// @return false when all have been sending or receiving for a short time only.
template <class Shared>
bool close_longest_waiting(Shared& shared) {
  const auto now = std::chrono::steady_clock::now();
  auto longest = shared.open.end();
  for (auto one = shared.open.begin(); one != shared.open.end(); ++one) {
    const Waiting& waiting = *one->second;
    if (waiting.what >= Waiting::For::body && now - waiting.since < kInPeace) continue;
    const bool is_longer = longest == shared.open.end() ||
                           std::pair{waiting.what, waiting.since} <
                               std::pair{longest->second->what, longest->second->since};
    if (is_longer) longest = one;
  }
  if (longest == shared.open.end()) return false;
  longest->first->close();
  shared.open.erase(longest);
  return true;
}

/// Sends a 503 to as many more clients as are being served; closes connections beyond those.
template <class Shared>
void receive(const std::shared_ptr<Shared>& shared, tcp::socket socket) {
  const auto limit = static_cast<std::size_t>(shared->connections_max);
  const bool is_welcome = shared->open.size() < limit || close_longest_waiting(*shared);
  if (shared->open.size() >= 2 * limit) return;
  const auto executor = shared->acceptor.get_executor();
  if (shared->tls) {
    boost::asio::co_spawn(executor, serve_tls(shared, std::move(socket), is_welcome),
                          asio::rethrown);
  } else {
    boost::asio::co_spawn(executor, serve_plain(shared, std::move(socket), is_welcome),
                          asio::rethrown);
  }
}

template <class Shared>
awaitable<void> accept_all(std::shared_ptr<Shared> shared) {
  boost::asio::steady_timer pause{shared->acceptor.get_executor()};
  while (shared->acceptor.is_open()) {
    boost::system::error_code error;
    tcp::socket socket =
        co_await shared->acceptor.async_accept(redirect_error(use_awaitable, error));
    if (!error) {
      // Posted, so that a failure with one client does not stop the next from being accepted.
      boost::asio::post(
          shared->acceptor.get_executor(),
          [shared, socket = std::move(socket)]() mutable { receive(shared, std::move(socket)); });
    } else if (shared->acceptor.is_open()) {
      // Usually out of descriptors. The client keeps waiting, so retrying at once would spin.
      pause.expires_after(kAfterAcceptFailed);
      co_await pause.async_wait(redirect_error(use_awaitable, error));
    }
  }
}

}  // namespace

/// TLS 1.2 and 1.3 only.
Result<Tls> read_tls(const TlsFiles& files) {
  using boost::asio::ssl::context;
  auto tls = std::make_shared<context>(context::tls_server);
  boost::system::error_code error;
  tls->set_options(context::default_workarounds | context::no_sslv2 | context::no_sslv3 |
                       context::no_tlsv1 | context::no_tlsv1_1 | context::single_dh_use,
                   error);
  if (!error) tls->use_certificate_chain_file(files.certificate.string(), error);
  if (error) {
    return failure(ErrorCode::io_failed, "certificate '" + files.certificate.string() +
                                             "' cannot be used: " + error.message());
  }
  // This also checks that the key belongs to the certificate.
  tls->use_private_key_file(files.key.string(), context::pem, error);
  if (error) {
    return failure(ErrorCode::io_failed,
                   "key '" + files.key.string() + "' cannot be used: " + error.message());
  }
  return tls;
}

Result<std::unique_ptr<Server>> Server::listen(boost::asio::io_context& context,
                                               const ServerOptions& options, Handler handler) {
  const auto endpoint = TRY(endpoint_of(options));
  auto shared = std::make_shared<Shared>(context, std::move(handler));
  if (options.tls) {
    shared->tls = TRY(read_tls(*options.tls));
  }
  boost::system::error_code error;
  shared->acceptor.open(endpoint.protocol(), error);
  if (!error) shared->acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) shared->acceptor.bind(endpoint, error);
  if (!error) shared->acceptor.listen(boost::asio::socket_base::max_listen_connections, error);
  if (error) {
    return failure(ErrorCode::io_failed, "cannot listen on " + options.address + " port " +
                                             std::to_string(options.port) + ": " + error.message());
  }
  shared->connections_max = options.connections_max;
  shared->rules = {.access = options.access,
                   .prompt_paths = options.prompt_paths,
                   .worker = options.worker,
                   .origins = options.origins,
                   .body_max = options.body_max,
                   .header_max = options.header_max,
                   .slow_client = options.slow_client};
  // Elsewhere the token is what a page of somebody else does not have.
  AccessRules& access = shared->rules.access;
  access.checks_host = endpoint.address().is_loopback() || !access.names.empty();
  boost::asio::co_spawn(context, accept_all(shared), asio::rethrown);
  return std::unique_ptr<Server>{new Server{std::move(shared)}};
}

Server::Server(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {}

Server::~Server() { stop(); }

std::uint16_t Server::port() const {
  boost::system::error_code ignored;
  return shared_->acceptor.local_endpoint(ignored).port();
}

void Server::set_tokens(std::vector<Token> tokens) {
  shared_->rules.access.tokens = std::move(tokens);
}

void Server::set_tls(Tls tls) {
  assert(shared_->tls != nullptr && tls != nullptr);
  shared_->tls = std::move(tls);
}

void Server::stop() {
  shared_->rules.is_stopping = true;
  boost::system::error_code ignored;
  shared_->acceptor.close(ignored);
  for (const auto& [stream, waiting] : shared_->open) stream->close();
}

}  // namespace recald::http
