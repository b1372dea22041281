/// How to reach a broker of MQTT, as a site file says it in [mqtt] and [fleet].
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "daemon/site/config/service/server_access.hpp"

namespace recald::daemon {

struct BrokerConfig {
  std::string host;
  std::uint16_t port = 1883;
  bool is_tls = false;
  Login login;
  std::filesystem::path trusted_certificate;  ///< Empty: what the system trusts.
  std::filesystem::path certificate_file;     ///< Of recald itself; empty: none.
  std::filesystem::path key_file;
  std::string client_id;

  /// "broker.example.org:1883"
  [[nodiscard]] std::string where() const;

  bool operator==(const BrokerConfig&) const = default;
};

/// Asks for the keys of a broker; problems are recorded at the table.
/// @param client_id  Unless the table has one.
[[nodiscard]] BrokerConfig read_broker(TomlReader& table, const std::filesystem::path& site_file,
                                       const std::string& client_id);

}  // namespace recald::daemon
