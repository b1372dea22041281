/// One question to a server, and its answer: for commands that talk to a running daemon.
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
  /// TLS: trust this certificate (PEM) and what it signed, whatever host it names; empty: trust
  /// what the system trusts, and only for the host asked.
  std::filesystem::path trusted_certificate;
  std::chrono::milliseconds timeout{5'000};  ///< For the whole of it.
  std::size_t body_max = 16 * 1024 * 1024;
};

/// Asks with GET; follows no redirections. Blocks.
/// @return any answer, whatever its status; or not_found: nobody answers there; io_failed: the
///         connection broke, took too long, is not trusted, or what came is not HTTP.
[[nodiscard]] Result<Response> get(const Url& url, const ClientOptions& options = {});

}  // namespace recald::http
