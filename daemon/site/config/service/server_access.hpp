/// How recald reaches a server outside: what it shows, and whom it trusts.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "adapters/toml/toml_reader.hpp"

namespace recald::daemon {

/// The path under a key; empty: absent.
[[nodiscard]] std::filesystem::path read_path(TomlReader& table, std::string_view key,
                                              const std::filesystem::path& site_file);

struct Login {
  std::string user;                     ///< Empty: the server asks for none.
  std::filesystem::path password_file;  ///< Of the user.

  bool operator==(const Login&) const = default;
};

/// `user` and `password_file`, which belong together.
[[nodiscard]] Login read_login(TomlReader& table, const std::filesystem::path& site_file);

/// How a server of that table is reached.
struct Reach {
  bool is_tls;
  std::string host;                   ///< Empty: of no address, which was said already.
  std::string_view secret;            ///< "password", what it would be sent; empty: nothing.
  std::string_view encrypted_scheme;  ///< "https"
};

/// What leaves this machine is encrypted, or the table says `encrypt = false`; secrets always are.
void check_encryption(TomlReader& table, const Reach& reach);

}  // namespace recald::daemon
