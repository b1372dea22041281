/// An HTTP/1.1 server on the daemon's loop: limits, deadlines, token and TLS; what is answered is
/// the handler's business.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "adapters/http/message.hpp"
#include "core/result.hpp"

namespace boost::asio {
class io_context;
namespace ssl {
class context;
}
}  // namespace boost::asio

namespace recald::http {

struct TlsFiles {
  std::filesystem::path certificate;  ///< PEM, the whole chain, own certificate first.
  std::filesystem::path key;          ///< PEM.
};

/// A certificate with its key, read and found to belong together; empty: none.
using Tls = std::shared_ptr<boost::asio::ssl::context>;
/// @return or io_failed: one of them cannot be read, or they do not belong together.
[[nodiscard]] Result<Tls> read_tls(const TlsFiles& files);

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< Numeric, IPv4 or IPv6.
  std::uint16_t port = 8080;          ///< 0: any that is free.
  std::string token;                  ///< Empty: none is asked for.
  std::set<std::string> open_paths;   ///< Answered without the token.
  std::optional<TlsFiles> tls;
  std::size_t body_max = 1024 * 1024;
  std::size_t header_max = 16 * 1024;  ///< Request line included.
  int connections_max = 64;  ///< Whoever comes then takes an idle one's place, or gets a 503.
  /// For a whole request to arrive, for an answer to leave, and between two requests.
  std::chrono::milliseconds slow_client{10'000};
};

class Server {
 public:
  /// Listens from now on; connections are served while the context runs.
  ///
  /// What clients do wrong is answered here: 400 malformed, 401 without the token (before the body
  /// is read), 413 and 431 too large, 503 too many connections. Who is slow is cut off, and
  /// of too many connections the one that has waited longest for a request.
  /// @param context  Run by one thread; outlives this.
  /// @param handler  Called on that thread, with whole requests only. What it throws is a 500.
  /// @return or invalid_value: not a numeric address, or one that others can reach without both a
  ///         token and TLS; io_failed: the address is in use or not ours, or the certificate or key
  ///         cannot be read or do not belong together.
  [[nodiscard]] static Result<std::unique_ptr<Server>> listen(boost::asio::io_context& context,
                                                              const ServerOptions& options,
                                                              Handler handler);
  ~Server();  ///< As stop().
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] std::uint16_t port() const;

  /// Another token from now on, so that it can be changed without a restart.
  void set_token(std::string token);

  /// Another certificate for connections to come; those that are open keep theirs.
  /// @pre it was listened to with TLS; `tls` is not empty
  void set_tls(Tls tls);

  /// No new connections, and the present ones are closed. The handler is not called any more.
  void stop();

 private:
  struct Shared;
  explicit Server(std::shared_ptr<Shared> shared);

  std::shared_ptr<Shared> shared_;  ///< With the sessions, which end after it.
};

}  // namespace recald::http
