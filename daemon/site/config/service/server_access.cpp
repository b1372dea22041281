#include "daemon/site/config/service/server_access.hpp"

#include <fmt/format.h>

#include "adapters/http/url.hpp"
#include "daemon/site/config/service/site_path.hpp"

namespace recald::daemon {

std::filesystem::path read_path(TomlReader& table, std::string_view key,
                                const std::filesystem::path& site_file) {
  const auto text = table.text(key);
  return text ? resolve(site_file, *text, key, table) : std::filesystem::path{};
}

Login read_login(TomlReader& table, const std::filesystem::path& site_file) {
  Login login{.user = table.text_or("user", ""),
              .password_file = read_path(table, "password_file", site_file)};
  if (login.user.empty() != login.password_file.empty()) {
    table.problem_at(table.has("user") ? "user" : "password_file",
                     "'user' and 'password_file' belong together");
  }
  return login;
}

void check_encryption(TomlReader& table, const Reach& reach) {
  const bool is_allowed = table.boolean("encrypt").value_or(true) == false;
  if (reach.is_tls || reach.host.empty() || http::is_this_machine(reach.host)) return;
  if (!reach.secret.empty()) {
    table.problem_at("url", fmt::format("'url' would send the {} without encryption; use {}",
                                        reach.secret, reach.encrypted_scheme));
  } else if (!is_allowed) {
    table.problem_at("url",
                     fmt::format("'url' leads to another machine without encryption: whoever is on "
                                 "the way reads and changes what is sent; use {}, or add encrypt = "
                                 "false if the network in between is trusted",
                                 reach.encrypted_scheme));
  }
}

}  // namespace recald::daemon
