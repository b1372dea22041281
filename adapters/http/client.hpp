/// Sends one request to a server, for commands that talk to a running daemon.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "adapters/http/message.hpp"
#include "adapters/http/url.hpp"
#include "core/result.hpp"

namespace recald::http {

struct ClientOptions {
  std::string token;  ///< Sent as a Bearer token; empty: none.
  /// TLS: trust this certificate (PEM) and any that it signed, for any host; empty: trust what the
  /// system trusts, and only for the requested host.
  std::filesystem::path trusted_certificate;
  std::chrono::milliseconds timeout{5'000};  ///< For the whole request and response.
  std::size_t body_max = 16 * 1024 * 1024;
};

/// Sends a GET; does not follow redirections. Blocks.
/// @return any response, whatever its status; or not_found: no server answers there; io_failed: the
///         connection broke, took too long or is not trusted, or the response is not HTTP.
[[nodiscard]] Result<Response> get(const Url& url, const ClientOptions& options = {});

}  // namespace recald::http
