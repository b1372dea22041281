#include "daemon/fleet/config/fleet_config.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "adapters/http/url.hpp"
#include "adapters/system/files/read_file.hpp"
#include "adapters/toml/toml_reader.hpp"
#include "daemon/site/config/service/server_access.hpp"

namespace recald::daemon {
namespace {

constexpr double kMegabyte = 1e6;

/// Whether libpq might send a password to another machine that only says that it is the database:
/// its default, and `allow` and `prefer`, take what the server offers.
bool is_in_the_clear(const std::string& url) {
  const std::size_t begin = url.find("//") + 2;
  const std::size_t end = std::min(url.find_first_of("/?", begin), url.size());
  std::string hosts = url.substr(begin, end - begin);
  hosts = hosts.substr(hosts.find('@') == std::string::npos ? 0 : hosts.find('@') + 1);
  std::string_view options{url};
  options.remove_prefix(std::min(url.find('?', begin), url.size()));
  const auto option = [&](std::string_view name) -> std::string {
    for (std::size_t at = options.find(name); at != std::string_view::npos;
         at = options.find(name, at + 1)) {
      if (at == 0 || (options[at - 1] != '?' && options[at - 1] != '&')) continue;
      const std::string_view rest = options.substr(at + name.size());
      return std::string{rest.substr(0, rest.find('&'))};
    }
    return "";
  };
  const std::string mode = option("sslmode=");
  if (mode == "verify-full" || mode == "verify-ca" || mode == "require" || mode == "disable") {
    return false;
  }
  hosts += "," + option("host=") + "," + option("hostaddr=");
  for (std::string_view rest{hosts}; !rest.empty();) {
    std::string host{rest.substr(0, rest.find(','))};
    rest.remove_prefix(std::min(host.size() + 1, rest.size()));
    const bool is_v6 = host.starts_with('[');
    host = is_v6 ? host.substr(1, host.find(']') - 1) : host.substr(0, host.find(':'));
    const bool is_socket =
        host.empty() || host.starts_with('/') || host.starts_with("%2F") || host.starts_with("%2f");
    if (!is_socket && !http::is_this_machine(host)) return true;
  }
  return false;
}

RecordConfig read_record(TomlReader& table, const std::filesystem::path& file) {
  RecordConfig config{.url = table.required_text("url"),
                      .password_file = read_path(table, "password_file", file)};
  const bool is_address =
      config.url.starts_with("postgresql://") || config.url.starts_with("postgres://");
  if (!config.url.empty() && !is_address) {
    table.problem_at("url",
                     "'url' is no address of PostgreSQL; write one such as "
                     "\"postgresql://recald@db.example.org/fleet\"");
  }
  // The address is logged and shown; "user:password@" is in its authority alone.
  const std::size_t begin = config.url.find("//");
  const std::string authority =
      is_address ? config.url.substr(begin + 2, config.url.find('/', begin + 2) - begin - 2) : "";
  const std::size_t at = authority.find('@');
  if (at != std::string::npos && authority.substr(0, at).find(':') != std::string::npos) {
    table.problem_at("url", "'url' has a password in it; write it into 'password_file'");
  }
  if (is_address && is_in_the_clear(config.url)) {
    table.problem_at(
        "url",
        "'url' leads to another machine without saying whether that is verified; end "
        "it in \"?sslmode=verify-full&sslrootcert=FILE\", or in \"?sslmode=disable\" if "
        "the network in between is trusted");
  }
  table.finish();
  return config;
}

WorkerConfig read_worker(TomlReader& table, const std::filesystem::path& file) {
  WorkerConfig config;
  config.jobs = table.whole_number_or("jobs", config.jobs, {0.0, 64.0});
  config.folder = read_path(table, "folder", file);
  // Processes of jobs work elsewhere.
  if (!config.folder.empty()) {
    config.folder = std::filesystem::absolute(config.folder).lexically_normal();
  }
  config.time_max = table.duration("time_max").value_or(config.time_max);
  config.memory_max_bytes = static_cast<std::uint64_t>(
      kMegabyte * table.number_or("memory_max_MB",
                                  static_cast<double>(config.memory_max_bytes) / kMegabyte,
                                  {500.0, 1e6}));
  table.finish();
  return config;
}

/// Two workers of one name would push each other off the broker.
std::string this_process() {
  std::array<char, 256> host{};
  (void)::gethostname(host.data(), host.size() - 1);
  return fmt::format("{}-{}", host.data(), ::getpid());
}

void read_root(TomlReader root, FleetConfig& config) {
  if (auto record = root.table("record")) {
    config.record = read_record(*record, config.file);
  } else {
    root.problem(
        "[record] is missing: the database of the fleet, such as url = "
        "\"postgresql://recald@db.example.org/fleet\"");
  }
  if (auto broker = root.table("mqtt")) {
    config.broker = read_broker(*broker, config.file, "recald-" + this_process());
    broker->finish();
  }
  if (auto worker = root.table("worker")) config.worker = read_worker(*worker, config.file);
  if (auto http = root.table("http")) config.http = read_http(*http, config.file);
  root.finish();
}

}  // namespace

tl::expected<FleetConfig, std::vector<std::string>> parse_fleet(std::string_view text,
                                                                const std::filesystem::path& file) {
  Problems problems;
  const std::string name = file.filename().string();
  FleetConfig config{.file = file};
  try {
    const toml::table root = parse_toml(text, name);
    read_root(TomlReader{root, name, "", problems}, config);
  } catch (const toml::parse_error& error) {
    problems.push_back(syntax_problem(name, error));
  }
  if (!problems.empty()) return tl::unexpected(problems);
  return config;
}

tl::expected<FleetConfig, std::vector<std::string>> load_fleet(const std::filesystem::path& file) {
  const auto text = system::read_file(file);
  if (!text) return tl::unexpected(Problems{text.error().message});
  return parse_fleet(*text, file);
}

}  // namespace recald::daemon
