#include "daemon/site/config/service/remote_write_config.hpp"

#include <fmt/format.h>

#include "adapters/http/url.hpp"

namespace recald::daemon {

RemoteWriteConfig read_remote_write(TomlReader& table, const std::filesystem::path& site_file) {
  RemoteWriteConfig config;
  if (!table.has("protocol")) table.problem("'protocol' is missing: \"prometheus\" or \"influx\"");
  if (table.word("protocol", {"prometheus", "influx"}) == "influx") {
    config.protocol = WriteProtocol::influx;
  }
  config.url = table.required_text("url");
  config.token_file = read_path(table, "token_file", site_file);
  config.login = read_login(table, site_file);
  config.trusted_certificate = read_path(table, "trusted_certificate", site_file);
  const auto url = http::parse_url(config.url);
  if (!url && !config.url.empty()) {
    table.problem_at("url",
                     "'url' is no address of http or https; write one such as "
                     "\"http://127.0.0.1:9090/api/v1/write\" (Prometheus) or "
                     "\"http://127.0.0.1:8086/write?db=buildings\" (InfluxDB)");
  }
  const bool is_influx = config.protocol == WriteProtocol::influx;
  if (url && is_influx && url->path.find("db=") == std::string::npos &&
      url->path.find("bucket=") == std::string::npos) {
    table.problem_at("url", "'url' names no database; end it in \"/write?db=NAME\"");
  }
  const bool has_secret = !config.token_file.empty() || !config.login.user.empty();
  check_encryption(table, {.is_tls = url && url->is_tls,
                           .host = url ? url->host : "",
                           .secret = has_secret ? "token or password" : "",
                           .encrypted_scheme = "https"});
  if (!config.token_file.empty() && !config.login.user.empty()) {
    table.problem_at("token_file", "the server takes a token or a user, not both");
  }
  table.finish();
  return config;
}

}  // namespace recald::daemon
