/// The address of a server.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace recald::http {

struct Url {
  bool is_tls = false;
  std::string host = "127.0.0.1";  ///< Name or address; IPv6 without brackets.
  std::uint16_t port = 80;
  std::string path = "/";  ///< As sent, query included.

  /// "http://host:port/path".
  [[nodiscard]] std::string text() const;
  /// Host and port as in a Host header.
  [[nodiscard]] std::string authority() const;
};

/// Whether what is sent to that host stays on this machine: localhost and the addresses of
/// loopback, not a name that only begins like one. @param host  In lower case, IPv6 without
/// brackets.
[[nodiscard]] bool is_this_machine(const std::string& host);

/// "http://host[:port][/path]" or https; the port is 80 or 443 unless given.
/// @return the address, or malformed.
[[nodiscard]] Result<Url> parse_url(std::string_view text);

}  // namespace recald::http
