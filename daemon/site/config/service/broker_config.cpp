#include "daemon/site/config/service/broker_config.hpp"

#include <fmt/format.h>

#include <optional>

#include "adapters/http/url.hpp"

namespace recald::daemon {
namespace {

/// The address after "mqtt://" or "mqtts://"; nothing for another text.
std::optional<http::Url> parse_broker(std::string_view url) {
  for (const bool is_tls : {false, true}) {
    const std::string_view scheme = is_tls ? "mqtts://" : "mqtt://";
    if (!url.starts_with(scheme)) continue;
    const std::string address{url.substr(scheme.size())};
    // Its usual port is none that a broker has.
    auto parsed = http::parse_url("http://" + address);
    if (!parsed || parsed->path != "/") return {};
    const bool has_port = address.find(':', address.rfind(']') + 1) != std::string::npos;
    if (!has_port) parsed->port = is_tls ? 8883 : 1883;
    parsed->is_tls = is_tls;
    return *parsed;
  }
  return {};
}

/// Secrets and certificates need a connection that is encrypted.
void check_certificates(TomlReader& table, const BrokerConfig& config) {
  check_encryption(table, {.is_tls = config.is_tls,
                           .host = config.host,
                           .secret = config.login.user.empty() ? "" : "password",
                           .encrypted_scheme = "mqtts"});
  if (config.is_tls || config.host.empty()) return;
  for (const char* key : {"trusted_certificate", "certificate_file"}) {
    if (!table.has(key)) continue;
    table.problem_at(
        key, fmt::format("'{}' belongs to an encrypted connection; use mqtts in 'url'", key));
  }
}

}  // namespace

std::string BrokerConfig::where() const {
  return http::Url{.host = host, .port = port}.authority();
}

BrokerConfig read_broker(TomlReader& table, const std::filesystem::path& site_file,
                         const std::string& client_id) {
  BrokerConfig config;
  const std::string url = table.required_text("url");
  if (const auto broker = parse_broker(url)) {
    config.host = broker->host;
    config.port = broker->port;
    config.is_tls = broker->is_tls;
  } else if (!url.empty()) {
    // Not what it is: somebody may have put the password into it, and this becomes an event.
    table.problem_at("url",
                     "'url' is no address of a broker; write one such as "
                     "\"mqtts://broker.example.org\" or \"mqtt://127.0.0.1:1883\"");
  }
  config.login = read_login(table, site_file);
  config.trusted_certificate = read_path(table, "trusted_certificate", site_file);
  config.certificate_file = read_path(table, "certificate_file", site_file);
  config.key_file = read_path(table, "key_file", site_file);
  if (config.certificate_file.empty() != config.key_file.empty()) {
    table.problem("'certificate_file' and 'key_file' belong together");
  }
  check_certificates(table, config);
  config.client_id = table.text_or("client_id", client_id);
  if (config.client_id.empty() || config.client_id.find_first_of(" \t\r\n") != std::string::npos) {
    table.problem_at("client_id",
                     fmt::format("'client_id' is \"{}\"; write one word such as \"{}\"",
                                 config.client_id, client_id));
  }
  return config;
}

}  // namespace recald::daemon
