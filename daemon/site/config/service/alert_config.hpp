/// Who is notified when something happens, as a site file says it.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "adapters/toml/toml_reader.hpp"

namespace recald::daemon {

struct WebhookConfig {
  std::string url;
  std::filesystem::path token_file;           ///< Empty: no token is sent.
  std::filesystem::path trusted_certificate;  ///< Empty: what the system trusts.
};

struct MailConfig {
  std::string server;  ///< "smtps://mail.example.org"
  std::string user;    ///< Empty: the server asks for none.
  std::filesystem::path password_file;
  bool encrypts = true;
  std::filesystem::path trusted_certificate;
  std::string from;
  std::vector<std::string> to;
};

using AlertDestination = std::variant<WebhookConfig, MailConfig>;

/// From one local time of day to another, over midnight if the second is not after the first.
struct QuietHours {
  std::chrono::minutes begin;
  std::chrono::minutes end;

  [[nodiscard]] bool contain(std::chrono::minutes time_of_day) const {
    if (begin < end) return time_of_day >= begin && time_of_day < end;
    return time_of_day >= begin || time_of_day < end;
  }
};

struct AlertConfig {
  std::string pages;  ///< Where the daemon's pages are reached, for links; empty: no links.
  std::optional<QuietHours> quiet;
  std::vector<std::string> about;  ///< Kinds of events, as in alert_kinds.hpp.
  std::vector<AlertDestination> destinations;
};

/// [alerts] with its [[alerts.webhook]] and [[alerts.mail]].
[[nodiscard]] AlertConfig read_alerts(TomlReader& table, const std::filesystem::path& site_file);

}  // namespace recald::daemon
