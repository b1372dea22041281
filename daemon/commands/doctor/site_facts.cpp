#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <regex>
#include <variant>

#include "adapters/http/certificate.hpp"
#include "adapters/http/credentials.hpp"
#include "adapters/stores/open.hpp"
#include "adapters/system/files/file_lock.hpp"
#include "adapters/system/files/sha256.hpp"
#include "adapters/system/machine.hpp"
#include "daemon/commands/doctor/facts.hpp"
#include "daemon/commands/meters/bus_access.hpp"
#include "daemon/commands/service/ask_daemon.hpp"
#include "daemon/gateway/upkeep/backups.hpp"
#include "daemon/gateway/upkeep/verify.hpp"

namespace recald::daemon {
namespace {

namespace fs = std::filesystem;

using Facts = std::vector<Fact>;

metering::Instant time_of_check() {
  return std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
}

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

/// Addresses of chats are secrets, those of mail servers may have a password in them, and whatever
/// else is quoted of [alerts] may be one that was written in the wrong place.
std::string without_secrets(const std::string& sentence) {
  static const std::regex quoted{R"re(".*")re"};
  static const std::regex address{R"([A-Za-z][A-Za-z0-9+.-]*://\S*)"};
  const bool is_of_alerts = sentence.find("[alerts") != std::string::npos;
  const std::string rest =
      is_of_alerts ? std::regex_replace(sentence, quoted, "(not shown)") : sentence;
  return std::regex_replace(rest, address, "(an address)");
}

Fact stopping(std::string name, std::string value, const std::string& problem) {
  return {std::move(name), std::move(value), without_secrets(problem), true};
}

Facts meters(const SiteConfig& site) {
  std::map<std::string_view, int> by_source;
  for (const auto* const list : {&site.meters, &site.sensors}) {
    for (const MeterConfig& meter : *list) ++by_source[name_of(meter.source)];
  }
  std::vector<std::string> words;
  for (const auto& [source, count] : by_source) {
    words.push_back(fmt::format("{} {}", count, source));
  }
  return {{"meters", fmt::format("{}{}", fmt::join(words, ", "),
                                 site.sensors.empty() ? "" : ", weather sensors among them")}};
}

/// What keeps a serial port from being used.
std::string why_not_usable(const std::string& device) {
  if (!is_there(device)) return fmt::format("{} does not exist; plug the adapter in", device);
  if (system::may_use(device)) return {};
  return fmt::format(
      "{} may not be opened by this user; run recald doctor as the daemon's user, and put that one "
      "into the port's group (usually dialout)",
      device);
}

Facts buses(const SiteConfig& site) {
  Facts facts;
  for (const BusConfig& bus : site.buses) {
    const std::string name = fmt::format("bus '{}'", bus.name);
    const auto* const serial = std::get_if<modbus::SerialPort>(&bus.endpoint);
    if (serial == nullptr) {
      facts.push_back({name, "TCP"});
      continue;
    }
    const std::string why = why_not_usable(serial->device);
    facts.push_back({name, serial->device, why, !why.empty()});
    if (const auto taken = why_bus_is_taken(bus)) facts.back().value += ", " + *taken;
  }
  return facts;
}

Facts store_file(const SiteConfig& site) {
  const fs::path& file = site.store.file;
  if (!is_there(file)) return {{"store", "none yet"}};
  double bytes = 0.0;
  for (const char* part : {"", "-wal"}) {
    std::error_code error;
    const auto size = fs::file_size(file.string() + part, error);
    if (!error) bytes += static_cast<double>(size);
  }
  const auto summary = stores::summary_of(file);
  if (!summary) return {stopping("store", size_words(bytes), summary.error().message)};
  return {{"store",
           fmt::format("{}, schema version {}, {} meter{}, {}", size_words(bytes),
                       summary->schema_version, summary->meters.size(),
                       summary->meters.size() == 1 ? "" : "s",
                       summary->newest ? "newest reading " + metering::to_string(*summary->newest)
                                       : "no readings")}};
}

Facts store_structure(const SiteConfig& site) {
  if (!is_there(site.store.file)) return {};
  const auto damage = stores::quick_damage_of(site.store.file);
  if (!damage) return {stopping("store's structure", "not checked", damage.error().message)};
  if (damage->empty()) return {{"store's structure", "intact; recald verify checks its rows"}};
  return {stopping("store's structure", "damaged", damaged_file(*damage))};
}

Facts disk(const SiteConfig& site) {
  std::error_code error;
  const auto space = fs::space(fs::absolute(site.store.file).parent_path(), error);
  if (error) return {stopping("disk", "unknown", "the store's folder: " + error.message())};
  Fact fact{"disk", size_words(static_cast<double>(space.available)) + " free beside the store"};
  constexpr std::uintmax_t kReserve = 64ULL << 20;
  if (space.available < 2 * kReserve) {
    fact.problem = "less than 128 MiB are free beside the store; make room";
    fact.stops_work = space.available == 0;
  }
  return {fact};
}

Facts backups(const SiteConfig& site) {
  const auto files = backups_of(site.store);
  Fact fact{"backups", fmt::format("{}", files.size())};
  if (!files.empty()) {
    const auto age = time_of_check() - std::chrono::sys_days{day_of(site.store, files.front())};
    const auto days = std::chrono::floor<std::chrono::days>(age).count();
    fact.value +=
        fmt::format(", the newest of {}", metering::to_string(day_of(site.store, files.front())));
    if (site.store.backup_at && days > 3) {
      fact.problem = fmt::format(
          "the newest backup is {} days old; see whether the daemon runs, and its events "
          "backup_failed",
          days);
    }
  }
  return {fact};
}

/// What a store of the current version tells; nothing of one that cannot be read, which other
/// facts say.
template <class StoreFacts>
Facts from_store(const SiteConfig& site, const StoreFacts& facts) {
  if (!is_there(site.store.file)) return {};
  const auto store = stores::open_untouched(site.store.file);
  return store ? facts(**store) : Facts{};
}

Facts events(const SiteConfig& site) {
  return from_store(site, [](Store& store) -> Facts {
    constexpr int kLooked = 1000;
    const auto events = store.events(kLooked);
    if (!events) return {stopping("events", "not read", events.error().message)};
    std::map<std::string, int> counts;
    std::vector<std::string> words;
    for (const StoreEvent& event : *events) {
      if (event.severity != Severity::info) counts[event.kind] += event.count;
    }
    for (const auto& [kind, count] : counts) words.push_back(fmt::format("{} {}", count, kind));
    return {{"events", fmt::format("of the newest {}: {}", events->size(),
                                   words.empty() ? "no warning"
                                                 : fmt::format("{}", fmt::join(words, ", ")))}};
  });
}

Facts jobs(const SiteConfig& site) {
  return from_store(site, [](Store& store) {
    Facts facts;
    for (const JobKind kind : {JobKind::calibration, JobKind::diagnosis}) {
      const auto newest = store.jobs(kind, 1);
      if (!newest || newest->empty()) continue;
      const StoredJob& job = newest->front();
      const bool is_refused = job.state == JobState::done && !job.accepted;
      facts.push_back(
          {fmt::format("newest {}", name_of(kind)),
           fmt::format("{}, {}{}, asked for at {}", job.number, name_of(job.state),
                       is_refused ? ", not accepted" : "", metering::to_string(job.asked))});
    }
    return facts;
  });
}

Facts running_daemon(const SiteConfig& site) {
  const bool is_held = system::FileLock::is_held(site.store.file.string() + ".lock");
  Fact fact{"daemon", is_held ? "a recald runs on the store" : "not running"};
  const auto question = question_for_site(site);
  if (!question) return {fact};
  const auto ready = ask(*question, "/readyz");
  if (ready) {
    const auto status = ready->find("status");
    fact.value += status != ready->end() && status->is_string()
                      ? ", answers: " + status->get<std::string>()
                      : ", answers";
  } else if (is_held) {
    fact.value += ", does not answer";
    fact.problem = without_secrets(ready.error().message);
    fact.stops_work = true;
  }
  return {fact};
}

Fact secret(const std::string& name, const Result<std::string>& read) {
  if (read) return {name, "can be read, by its owner alone"};
  return stopping(name, "cannot be used", read.error().message);
}

Fact key_file(const fs::path& file) {
  if (const std::string why = system::why_unreadable(file); !why.empty()) {
    return stopping("[http] key_file", "cannot be read", file.string() + " " + why);
  }
  Fact fact{"[http] key_file", "can be read"};
  std::error_code ignored;
  const fs::perms rights = fs::status(file, ignored).permissions();
  if ((rights & fs::perms::others_all) != fs::perms::none) {
    fact.problem = fmt::format("everybody may read {}; chmod 640 or stricter", file.string());
  }
  return fact;
}

Fact certificate(const fs::path& file) {
  const auto end = http::end_of_certificate(file);
  if (!end) return stopping("[http] certificate_file", "cannot be used", end.error().message);
  Fact fact{"[http] certificate_file", "ends " + metering::to_string(*end)};
  constexpr std::chrono::days kSoon{30};
  if (*end < time_of_check()) {
    return stopping(fact.name, fact.value, "the certificate has ended; put a new one in its place");
  }
  if (*end < time_of_check() + kSoon)
    fact.problem = "the certificate ends within 30 days; get a new one";
  return fact;
}

Facts secrets(const SiteConfig& site) {
  Facts facts;
  if (site.http && !site.http->token_file.empty()) {
    facts.push_back(secret("[http] token_file", http::read_token_file(site.http->token_file)));
  }
  if (site.http) {
    for (const TokenConfig& one : site.http->tokens) {
      facts.push_back(secret(fmt::format("[http] token {}", one.file.filename().string()),
                             http::read_token_file(one.file)));
    }
  }
  if (site.http && !site.http->certificate_file.empty()) {
    facts.push_back(certificate(site.http->certificate_file));
    facts.push_back(key_file(site.http->key_file));
  }
  int number = 0;
  for (const AlertDestination& one : site.alerts.destinations) {
    ++number;
    if (const auto* mail = std::get_if<MailConfig>(&one); mail && !mail->password_file.empty()) {
      facts.push_back(secret(fmt::format("[alerts] destination {}: password_file", number),
                             http::read_password_file(mail->password_file)));
    }
    if (const auto* hook = std::get_if<WebhookConfig>(&one); hook && !hook->token_file.empty()) {
      facts.push_back(secret(fmt::format("[alerts] destination {}: token_file", number),
                             http::read_token_file(hook->token_file)));
    }
  }
  const auto add_broker = [&](const std::string& name, const BrokerConfig& broker) {
    if (broker.login.user.empty()) return;
    facts.push_back(
        secret(name + " password_file", http::read_password_file(broker.login.password_file)));
  };
  if (site.mqtt) add_broker("[mqtt]", site.mqtt->broker);
  if (site.fleet) add_broker("[fleet]", *site.fleet);
  for (const RemoteWriteConfig& write : site.remote_writes) {
    if (!write.token_file.empty()) {
      facts.push_back(secret("[remote_write] token_file", http::read_token_file(write.token_file)));
    }
    if (!write.login.user.empty()) {
      facts.push_back(secret("[remote_write] password_file",
                             http::read_password_file(write.login.password_file)));
    }
  }
  return facts;
}

constexpr std::array kOfSite{meters,  named_files, buses, store_file,     store_structure, disk,
                             backups, events,      jobs,  running_daemon, secrets};

}  // namespace

std::vector<Fact> site_facts(const fs::path& file) {
  system::Sha256 sum;
  const auto added = sum.add_file(file);
  Facts facts;
  facts.push_back({"site file", fmt::format("{}, SHA-256 {}", file.filename().string(),
                                            added ? sum.hex() : "unknown")});
  const auto site = load_site(file);
  if (!site) {
    for (const std::string& problem : site.error()) {
      facts.push_back(stopping("site file", "has a problem", problem));
    }
    return facts;
  }
  for (const auto& find_out : kOfSite) {
    for (Fact& fact : find_out(*site)) facts.push_back(std::move(fact));
  }
  return facts;
}

}  // namespace recald::daemon
