/// A site's server, as its [http] describes it.
#pragma once

#include <memory>

#include "adapters/http/server.hpp"
#include "daemon/gateway/serve/served.hpp"
#include "daemon/site/config/service_config.hpp"

namespace recald::daemon {

/// Listens, with the token and the certificate that the configuration names. /healthz and /readyz
/// are answered without the token, so that a supervisor needs no secret.
/// @param context  Run by one thread; outlives the server.
/// @param served   What it refers to outlives the server.
/// @return or what http::read_token_file and http::Server::listen refuse.
[[nodiscard]] Result<std::unique_ptr<http::Server>> serve_site(boost::asio::io_context& context,
                                                               const HttpConfig& config,
                                                               Served served);

}  // namespace recald::daemon
