#include "daemon/gateway/serve/site_server.hpp"

#include <utility>

#include "adapters/http/credentials.hpp"

namespace recald::daemon {

Result<http::ServerOptions> server_options(const HttpConfig& config) {
  http::ServerOptions options{.address = config.address,
                              .port = config.port,
                              .open_paths = {"/healthz", "/readyz"},
                              .origins = {config.origins.begin(), config.origins.end()}};
  if (!config.token_file.empty()) {
    options.token = TRY(http::read_token_file(config.token_file));
  }
  if (!config.certificate_file.empty()) {
    options.tls = http::TlsFiles{config.certificate_file, config.key_file};
  }
  return options;
}

Result<std::unique_ptr<http::Server>> serve_site(boost::asio::io_context& context,
                                                 const HttpConfig& config, Served served) {
  const auto options = TRY(server_options(config));
  return http::Server::listen(context, options,
                              [served = std::move(served)](const http::Request& request) {
                                return answer(served, request);
                              });
}

}  // namespace recald::daemon
