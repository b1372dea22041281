#include "daemon/site/config/service/alert_config.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "adapters/http/url.hpp"
#include "daemon/site/config/service/alert_kinds.hpp"
#include "daemon/site/config/service/server_access.hpp"

namespace recald::daemon {
namespace {

bool is_mail_address(std::string_view text) {
  const std::size_t at = text.find('@');
  const bool has_both_sides = at != 0 && at != std::string_view::npos && at + 1 < text.size();
  return has_both_sides && text.find('@', at + 1) == std::string_view::npos &&
         text.find_first_of(" <>()[],;:\\\"") == std::string_view::npos &&
         std::ranges::all_of(text, [](char c) { return c > ' ' && c <= '~'; });
}

void check_mail_address(TomlReader& table, std::string_view key, const std::string& address) {
  if (is_mail_address(address)) return;
  table.problem_at(key, fmt::format("'{}' has \"{}\"; write a mail address such as "
                                    "\"operator@example.org\"",
                                    key, address));
}

/// The host of "smtp://HOST[:PORT]" or "smtps://…"; nothing for another text.
std::optional<std::string> mail_host(const std::string& url) {
  for (const std::string_view scheme : {"smtp://", "smtps://"}) {
    if (!url.starts_with(scheme)) continue;
    const auto parsed = http::parse_url("http://" + url.substr(scheme.size()));
    if (parsed && parsed->path == "/") return parsed->host;
  }
  return {};
}

WebhookConfig read_webhook(TomlReader table, const std::filesystem::path& site_file) {
  WebhookConfig config{.url = table.required_text("url"),
                       .token_file = read_path(table, "token_file", site_file),
                       .trusted_certificate = read_path(table, "trusted_certificate", site_file)};
  const auto url = http::parse_url(config.url);
  if (!url && !config.url.empty()) {
    // Not what it is: the addresses of chats are secrets, and this becomes an event.
    table.problem_at("url",
                     "'url' is no address of http or https; write one such as "
                     "\"https://hooks.example.org/recald\"");
  }
  check_encryption(table, {.is_tls = url && url->is_tls,
                           .host = url ? url->host : "",
                           .secret = config.token_file.empty() ? "" : "token",
                           .encrypted_scheme = "https"});
  table.finish();
  return config;
}

MailConfig read_mail(TomlReader table, const std::filesystem::path& site_file) {
  MailConfig config;
  config.server = table.required_text("server");
  Login login = read_login(table, site_file);
  config.user = std::move(login.user);
  config.password_file = std::move(login.password_file);
  config.trusted_certificate = read_path(table, "trusted_certificate", site_file);
  config.from = table.required_text("from");
  if (!config.from.empty()) check_mail_address(table, "from", config.from);
  config.to = table.one_or_more("to").value_or(std::vector<std::string>{});
  if (!table.has("to")) table.problem("'to' is missing");
  for (const std::string& address : config.to) check_mail_address(table, "to", address);
  const auto host = mail_host(config.server);
  if (!host && !config.server.empty()) {
    table.problem_at("server",
                     fmt::format("'server' is \"{}\"; write an address such as "
                                 "\"smtps://mail.example.org\" or \"smtp://mail.example.org:587\"",
                                 config.server));
  }
  config.encrypts = table.boolean("encrypt").value_or(!host || !http::is_this_machine(*host));
  if (!config.encrypts && !config.user.empty() && host && !http::is_this_machine(*host)) {
    table.problem_at("encrypt",
                     "the password would be sent without encryption; leave 'encrypt' "
                     "out, or 'user' and 'password_file'");
  }
  table.finish();
  return config;
}

std::optional<QuietHours> read_quiet(TomlReader& table) {
  const auto text = table.text("quiet");
  if (!text) return {};
  const std::size_t dash = text->find('-');
  if (dash != std::string::npos) {
    const auto begin = parse_time_of_day(std::string_view{*text}.substr(0, dash));
    const auto end = parse_time_of_day(std::string_view{*text}.substr(dash + 1));
    if (begin && end && *begin != *end) return QuietHours{*begin, *end};
  }
  table.problem_at("quiet", fmt::format("'quiet' is \"{}\"; write two different local times of day "
                                        "such as \"22:00-07:00\"",
                                        *text));
  return {};
}

std::vector<std::string> read_about(TomlReader& table) {
  std::vector<std::string> about;
  if (auto chosen = table.one_or_more("about")) {
    for (std::string& kind : *chosen) {
      if (find_alert_kind(kind) == nullptr) {
        std::vector<std::string_view> known;
        for (const AlertKind& one : alert_kinds()) known.push_back(one.kind);
        table.problem_at("about", fmt::format("'about' has \"{}\"; the kinds are {}", kind,
                                              fmt::join(known, ", ")));
      }
      about.push_back(std::move(kind));
    }
    return about;
  }
  for (const AlertKind& one : alert_kinds()) {
    if (one.is_usual) about.emplace_back(one.kind);
  }
  return about;
}

}  // namespace

AlertConfig read_alerts(TomlReader& table, const std::filesystem::path& site_file) {
  AlertConfig config;
  config.pages = table.text_or("pages", "");
  if (table.has("pages") && !http::parse_url(config.pages)) {
    table.problem_at("pages",
                     fmt::format("'pages' is \"{}\"; write the address where the daemon's pages "
                                 "are reached, such as \"https://gateway.example.org:8080\"",
                                 config.pages));
  }
  while (config.pages.ends_with('/')) config.pages.pop_back();
  config.quiet = read_quiet(table);
  config.about = read_about(table);
  for (TomlReader& webhook : table.tables("webhook")) {
    config.destinations.emplace_back(read_webhook(std::move(webhook), site_file));
  }
  for (TomlReader& mail : table.tables("mail")) {
    config.destinations.emplace_back(read_mail(std::move(mail), site_file));
  }
  if (config.destinations.empty()) {
    table.problem("there is nobody to tell; add [[alerts.webhook]] or [[alerts.mail]]");
  }
  table.finish();
  return config;
}

}  // namespace recald::daemon
