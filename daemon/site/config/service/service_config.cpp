#include "daemon/site/config/service/service_config.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <regex>

#include "adapters/http/url.hpp"
#include "core/text/ascii.hpp"
#include "daemon/site/config/service/site_path.hpp"

namespace recald::daemon {
namespace {

/// "127.0.0.1:8080", "[::1]:8080"; the port may be 0.
struct Endpoint {
  std::string address;
  std::uint16_t port;
};

std::optional<Endpoint> parse_endpoint(std::string_view text) {
  const auto colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0) return {};
  std::string_view address = text.substr(0, colon);
  const std::string_view digits = text.substr(colon + 1);
  std::uint16_t port = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  if (read.ec != std::errc{} || read.ptr != digits.data() + digits.size()) return {};
  if (address.starts_with('[') && address.ends_with(']')) {
    address = address.substr(1, address.size() - 2);
  } else if (address.find(':') != std::string_view::npos) {
    return {};  // an IPv6 address without brackets: where does the port begin?
  }
  return Endpoint{std::string{address}, port};
}

bool is_ip_address(const std::string& text) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  return ::inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 ||
         ::inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1;
}

/// 0.0.0.0 and ::, however they are written.
bool is_every_interface(std::string_view address) {
  return address.find_first_not_of("0.:") == std::string_view::npos;
}

std::vector<TokenConfig> read_tokens(TomlReader& table, const std::filesystem::path& site_file) {
  constexpr std::array<std::string_view, 3> kRights{"read", "push", "operate"};
  std::vector<TokenConfig> tokens;
  for (TomlReader& one : table.tables("token")) {
    TokenConfig token{.file = resolve(site_file, one.required_text("file"), "file", one),
                      .rights = one.one_or_more("rights").value_or(std::vector<std::string>{})};
    if (token.rights.empty()) {
      one.problem_at("rights", R"('rights' is needed, such as ["read"] or ["read", "push"])");
    }
    for (const std::string& right : token.rights) {
      if (std::ranges::find(kRights, right) != kRights.end()) continue;
      one.problem_at(
          "rights", fmt::format("'rights' must be of \"read\", \"push\" (readings) and \"operate\" "
                                "(jobs and models), not \"{}\"",
                                right));
    }
    one.finish();
    tokens.push_back(std::move(token));
  }
  return tokens;
}

std::vector<std::string> read_names(TomlReader& table) {
  auto names = table.one_or_more("names").value_or(std::vector<std::string>{});
  for (std::string& name : names) {
    static const std::regex kHost{"[a-z0-9]([a-z0-9.-]*[a-z0-9])?"};
    name = to_lower(name);
    if (std::regex_match(name, kHost)) continue;
    table.problem_at("names",
                     fmt::format("'names' has \"{}\"; write hosts without scheme and port, "
                                 "such as \"tower.example.org\"",
                                 name));
  }
  return names;
}

}  // namespace

HttpConfig read_http(TomlReader& table, const std::filesystem::path& site_file) {
  HttpConfig config;
  if (const auto listen = table.text("listen")) {
    if (const auto endpoint = parse_endpoint(*listen)) {
      config.address = endpoint->address == "localhost" ? "127.0.0.1" : endpoint->address;
      config.port = endpoint->port;
    } else {
      table.problem_at("listen", fmt::format("'listen' is \"{}\"; write an address and a port such "
                                             "as \"127.0.0.1:8080\" or \"[::1]:8080\"",
                                             *listen));
    }
  }
  const auto path = [&](std::string_view key) -> std::filesystem::path {
    const auto text = table.text(key);
    return text ? resolve(site_file, *text, key, table) : std::filesystem::path{};
  };
  config.token_file = path("token_file");
  config.certificate_file = path("certificate_file");
  config.key_file = path("key_file");
  for (std::string& origin :
       table.one_or_more("allow_origin").value_or(std::vector<std::string>{})) {
    // As browsers send it: lower case, and no port where it is the usual one.
    static const std::regex kOrigin{R"(https?://[a-z0-9.-]+(:[0-9]{1,5})?)"};
    const bool has_usual_port = (origin.starts_with("https:") && origin.ends_with(":443")) ||
                                (origin.starts_with("http:") && origin.ends_with(":80"));
    const bool is_origin = std::regex_match(origin, kOrigin) && !has_usual_port;
    if (!is_origin) {
      table.problem_at(
          "allow_origin",
          fmt::format(
              "'allow_origin' has \"{}\"; write a scheme and a host in lower case, "
              "and a port only if it is not the usual one, such as \"https://bms.example.org\"",
              origin));
    }
    config.origins.push_back(std::move(origin));
  }
  config.tokens = read_tokens(table, site_file);
  config.names = read_names(table);
  if (table.has("certificate_file") != table.has("key_file")) {
    table.problem("TLS needs both 'certificate_file' and 'key_file'");
  }
  const bool has_token = table.has("token_file") || !config.tokens.empty();
  if (!http::is_this_machine(config.address) && (!has_token || !table.has("certificate_file"))) {
    table.problem_at("listen",
                     fmt::format("'listen' opens {} to other machines; add 'token_file', "
                                 "'certificate_file' and 'key_file', or listen on 127.0.0.1",
                                 config.address));
  }
  table.finish();
  return config;
}

ModbusConfig read_modbus(TomlReader& table) {
  ModbusConfig config;
  const std::string listen = table.required_text("listen");
  auto endpoint = parse_endpoint(listen);
  if (endpoint && endpoint->address == "localhost") endpoint->address = "127.0.0.1";
  if (listen.empty()) {
    // reported already
  } else if (!endpoint || !is_ip_address(endpoint->address)) {
    table.problem_at("listen",
                     fmt::format("'listen' is \"{}\"; write the IP address of an interface and a "
                                 "port such as \"10.20.0.5:502\" or \"[fd00::5]:502\"",
                                 listen));
  } else if (is_every_interface(endpoint->address)) {
    table.problem_at("listen",
                     fmt::format("'listen' is \"{}\", which is every interface, and Modbus has no "
                                 "password; write the address of the one that the management "
                                 "system is on",
                                 listen));
  } else {
    config = {endpoint->address, endpoint->port};
  }
  table.finish();
  return config;
}

RecalibrationConfig read_recalibration(TomlReader& table, const std::filesystem::path& site_file) {
  RecalibrationConfig config;
  if (const auto text = table.text("schedule")) {
    if (const auto schedule = parse_schedule(*text)) {
      config.schedule = *schedule;
    } else {
      table.problem_at("schedule", "'schedule': " + schedule.error().message);
    }
  }
  config.months = table.whole_number_or("months", config.months, {6, 120});
  if (const auto text = table.text("design")) {
    config.design = resolve(site_file, *text, "design", table);
  }
  table.finish();
  return config;
}

}  // namespace recald::daemon
