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

/// Whether what is sent to that host stays on this machine.
[[nodiscard]] bool is_this_machine(std::string_view host);

struct Login {
  std::string user;                     ///< Empty: the server asks for none.
  std::filesystem::path password_file;  ///< Of the user.

  bool operator==(const Login&) const = default;
};

/// `user` and `password_file`, which belong together.
[[nodiscard]] Login read_login(TomlReader& table, const std::filesystem::path& site_file);

}  // namespace recald::daemon
