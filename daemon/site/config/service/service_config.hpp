/// How the daemon serves and what it does by itself, as a site file says it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adapters/toml/toml_reader.hpp"
#include "daemon/site/config/service/schedule.hpp"

namespace recald::daemon {

/// A token with some rights.
struct TokenConfig {
  std::filesystem::path file;
  std::vector<std::string> rights;  ///< "read", "push", "operate"
};

struct HttpConfig {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;               ///< 0: one that is free.
  std::filesystem::path token_file;        ///< With all rights; empty: none.
  std::vector<TokenConfig> tokens;         ///< [[http.token]]; with none at all, none is asked for.
  std::vector<std::string> names;          ///< Hosts that the server is called, in lower case.
  std::filesystem::path certificate_file;  ///< Empty: no TLS.
  std::filesystem::path key_file;
  std::vector<std::string> origins;  ///< Whose pages may ask from a browser.
};

/// Where results are served as Modbus registers.
struct ModbusConfig {
  std::string address;     ///< Of one interface, as a number.
  std::uint16_t port = 0;  ///< 0: one that is free.
};

struct RecalibrationConfig {
  Schedule schedule{.when_a_month_closes = true, .times = {}};
  int months = 24;  ///< The last so many closed months are fitted.
  /// Folder of a design of experiments (`recald doe`) whose meta-model is calibrated; empty: the
  /// site's model itself is.
  std::filesystem::path design;
};

/// [http]. Whoever listens beyond this machine needs a token and TLS.
[[nodiscard]] HttpConfig read_http(TomlReader& table, const std::filesystem::path& site_file);

/// [modbus]. Modbus has no password, so one interface is named, and not all of them.
[[nodiscard]] ModbusConfig read_modbus(TomlReader& table);

/// [recalibration]
[[nodiscard]] RecalibrationConfig read_recalibration(TomlReader& table,
                                                     const std::filesystem::path& site_file);

}  // namespace recald::daemon
