/// A site's HTTP server, as configured in [http].
#pragma once

#include <memory>
#include <vector>

#include "adapters/http/server.hpp"
#include "daemon/gateway/serve/api/served.hpp"
#include "daemon/site/config/service/service_config.hpp"

namespace recald::daemon {

/// The tokens of [http], with their rights. @return or an error of http::read_token_file.
[[nodiscard]] Result<std::vector<http::Token>> read_tokens(const HttpConfig& config);

/// Address, token and certificate as configured. /healthz and /readyz need no token, so that a
/// supervisor needs no secret.
/// @return or an error of http::read_token_file.
[[nodiscard]] Result<http::ServerOptions> server_options(const HttpConfig& config);

/// Listens with the configured options.
/// @param context  Run by one thread; outlives the server.
/// @param served   Everything it refers to outlives the server.
/// @return the server, or an error of server_options or http::Server::listen.
[[nodiscard]] Result<std::unique_ptr<http::Server>> serve_site(boost::asio::io_context& context,
                                                               const HttpConfig& config,
                                                               Served served);

}  // namespace recald::daemon
