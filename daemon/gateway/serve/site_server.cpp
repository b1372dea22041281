#include "daemon/gateway/serve/site_server.hpp"

#include <algorithm>
#include <utility>

#include "adapters/http/credentials.hpp"

namespace recald::daemon {

Result<std::vector<http::Token>> read_tokens(const HttpConfig& config) {
  std::vector<http::Token> tokens;
  if (!config.token_file.empty()) {
    tokens.push_back({.text = TRY(http::read_token_file(config.token_file))});
  }
  for (const TokenConfig& one : config.tokens) {
    http::Token token{.text = TRY(http::read_token_file(one.file)), .rights = {}};
    for (const http::Right right : {http::Right::read, http::Right::push, http::Right::operate}) {
      const bool is_given = std::ranges::find(one.rights, name_of(right)) != one.rights.end();
      if (is_given) token.rights.insert(right);
    }
    tokens.push_back(std::move(token));
  }
  return tokens;
}

Result<http::ServerOptions> server_options(const HttpConfig& config) {
  http::ServerOptions options{.address = config.address,
                              .port = config.port,
                              .prompt_paths = {"/healthz", "/readyz"},
                              .origins = {config.origins.begin(), config.origins.end()}};
  options.access = {.tokens = TRY(read_tokens(config)),
                    .open_paths = {"/healthz", "/readyz"},
                    .push_paths = {"/api/v1/readings"},
                    .names = {config.names.begin(), config.names.end()}};
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
