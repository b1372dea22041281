/// A database of time series that is sent every interval and month, as a site file says it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "daemon/site/config/service/server_access.hpp"

namespace recald::daemon {

enum class WriteProtocol : std::uint8_t { prometheus, influx };

/// [[remote_write]]
struct RemoteWriteConfig {
  WriteProtocol protocol = WriteProtocol::prometheus;
  std::string url;
  std::filesystem::path token_file;  ///< Empty: no token is sent.
  Login login;
  std::filesystem::path trusted_certificate;  ///< Empty: what the system trusts.

  bool operator==(const RemoteWriteConfig&) const = default;
};

[[nodiscard]] RemoteWriteConfig read_remote_write(TomlReader& table,
                                                  const std::filesystem::path& site_file);

}  // namespace recald::daemon
