#include "daemon/site/config/service/server_access.hpp"

#include "daemon/site/config/service/site_path.hpp"

namespace recald::daemon {

std::filesystem::path read_path(TomlReader& table, std::string_view key,
                                const std::filesystem::path& site_file) {
  const auto text = table.text(key);
  return text ? resolve(site_file, *text, key, table) : std::filesystem::path{};
}

bool is_this_machine(std::string_view host) {
  return host == "localhost" || host == "::1" || host.starts_with("127.");
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

}  // namespace recald::daemon
