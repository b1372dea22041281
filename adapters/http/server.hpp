/// An HTTP/1.1 server on the daemon's loop: limits, deadlines, token and TLS. The handler decides
/// the responses.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "adapters/http/access.hpp"
#include "adapters/http/message.hpp"
#include "adapters/ports/worker.hpp"
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

/// A certificate with its matching key; empty: none.
using Tls = std::shared_ptr<boost::asio::ssl::context>;
/// @return io_failed: one of them cannot be read, or they do not belong together.
[[nodiscard]] Result<Tls> read_tls(const TlsFiles& files);

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< Numeric, IPv4 or IPv6.
  std::uint16_t port = 8080;          ///< 0: any free port.
  /// `checks_host` is set by the server: on a loopback address always, elsewhere with `names`.
  AccessRules access;
  /// Answered at once; other paths in turn, with pauses after long answers.
  std::set<std::string> prompt_paths;
  /// Makes the other answers, so that the loop does not wait for what they wait for; used by nobody
  /// else, and ends before the context. Null: the handler is called on the loop's thread.
  Worker* worker = nullptr;
  std::set<std::string> origins;  ///< Whose pages may ask from a browser; empty: none but ours.
  std::optional<TlsFiles> tls;
  std::size_t body_max = 1024 * 1024;
  std::size_t header_max = 16 * 1024;  ///< Includes the request line.
  int connections_max = 64;            ///< A further one replaces one that waits, or gets a 503.
  /// For a whole request to arrive, for a response to leave, and between two requests.
  std::chrono::milliseconds slow_client{10'000};
};

class Server {
 public:
  /// Starts listening; connections are served while the context runs.
  ///
  /// The server itself answers clients' mistakes: 400 malformed, 401, 403 and 421 as
  /// `refusal_of_access` (before the body is read), 413 and 431 too large, 503 too many
  /// connections. It disconnects slow clients, and if there are too many connections, one that
  /// waits.
  /// @param context  Run by one thread; outlives this.
  /// @param handler  Called on that thread, or on the worker's, with whole requests only. If it
  ///                 throws, we send a 500.
  /// @return the server; or invalid_value: not a numeric address, or one that others can reach
  ///         without both a token and TLS; io_failed: the address is in use or not ours, or the
  ///         certificate or key cannot be read or do not belong together.
  [[nodiscard]] static Result<std::unique_ptr<Server>> listen(boost::asio::io_context& context,
                                                              const ServerOptions& options,
                                                              Handler handler);
  ~Server();  ///< As stop().
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] std::uint16_t port() const;

  /// Replaces the tokens without a restart.
  void set_tokens(std::vector<Token> tokens);

  /// Replaces the certificate for new connections; open ones keep theirs.
  /// @pre the server listens with TLS; `tls` is not empty
  void set_tls(Tls tls);

  /// Accepts no new connections and closes the present ones. The handler is not called any more.
  void stop();

 private:
  struct Shared;
  explicit Server(std::shared_ptr<Shared> shared);

  std::shared_ptr<Shared> shared_;  ///< Shared with the sessions, which end after it.
};

}  // namespace recald::http
