/// Plays the gateways of many sites: sends the past of one store under many names, each site's
/// values times a factor of its own, a batch at a time as a gateway does, and measures how fast the
/// record takes it.
///
///     fleet_load SITE.toml HOST PORT USER PASSWORD SITES AT_ONCE SECONDS
///
/// SITE.toml: its store has the past. Sites are called fleet-0001 and so on. SECONDS: stops then;
/// 0: when all is told. Prints a JSON object.
#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "adapters/mqtt/connection.hpp"
#include "adapters/record/record_batch.hpp"
#include "adapters/stores/open.hpp"
#include "core/random/rng.hpp"
#include "daemon/gateway/forward/outbox/store_history.hpp"
#include "daemon/site/config/site_config.hpp"

namespace {

using namespace recald;
using std::chrono::steady_clock;

constexpr std::size_t kBatch = 500;
constexpr std::chrono::seconds kAgain{30};
constexpr std::int64_t kOutbox = 1;

struct PlayedSite {
  std::string id;
  double factor = 1.0;
  std::size_t sent = 0;       ///< Entries up to here are on their way.
  std::size_t confirmed = 0;  ///< Entries that the record has.
  steady_clock::time_point sent_at;
};

std::vector<OutboxEntry> past_of(const daemon::SiteConfig& site) {
  std::vector<daemon::MeterInStore> meters;
  for (const auto& one : site.meters) {
    if (one.is_stored()) meters.push_back({one.meter.id, one.meter.interval});
  }
  const auto store = stores::open_to_read(site.store.file).value();
  auto entries = daemon::history_after(*store, meters, 0, std::numeric_limits<int>::max()).value();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    entries[i].number = static_cast<std::int64_t>(i) + 1;
  }
  return entries;
}

void scale(OutboxEntry& entry, double factor) {
  if (auto* const one = std::get_if<StoredInterval>(&entry.stored)) {
    one->reading.mean_kW *= factor;
  } else if (auto* const month = std::get_if<StoredMonth>(&entry.stored)) {
    month->figure.daily_average_kWh *= factor;
    month->figure.daily_average_variance_kWh2 *= factor * factor;
    if (month->figure.peak) month->figure.peak->kW *= factor;
  }
}

mqtt::Message next_batch(PlayedSite& site, const std::vector<OutboxEntry>& past) {
  record::RecordBatch batch{.outbox = kOutbox,
                            .after = {.entries = static_cast<std::int64_t>(site.confirmed)}};
  site.sent = std::min(site.confirmed + kBatch, past.size());
  for (std::size_t i = site.confirmed; i < site.sent; ++i) {
    batch.entries.push_back(past[i]);
    scale(batch.entries.back(), site.factor);
  }
  site.sent_at = steady_clock::now();
  return {.topic = record::batch_topic(site.id), .payload = record::to_json(batch)};
}

/// What the connection's thread hears.
struct Heard {
  std::mutex mutex;
  std::condition_variable changed;
  std::map<std::string, std::int64_t> entries;
  bool is_connected = false;
};

int number(const char* text) {
  int value = 0;
  std::from_chars(text, text + std::strlen(text), value);
  return value;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 9) {
    std::fprintf(stderr, "fleet_load SITE.toml HOST PORT USER PASSWORD SITES AT_ONCE SECONDS\n");
    return 2;
  }
  const auto config = daemon::load_site(argv[1]);
  if (!config) {
    std::fprintf(stderr, "%s\n", config.error().front().c_str());
    return 1;
  }
  const auto past = past_of(*config);
  std::vector<PlayedSite> sites;
  Rng rng{7};
  for (int i = 1; i <= number(argv[6]); ++i) {
    sites.push_back({.id = fmt::format("fleet-{:04}", i), .factor = rng.uniform(0.7, 1.3)});
  }
  const auto at_once = static_cast<std::size_t>(number(argv[7]));
  const std::chrono::seconds limit{number(argv[8])};
  Heard heard;
  auto connection = mqtt::Connection::open(
                        {.host = argv[2],
                         .port = static_cast<std::uint16_t>(number(argv[3])),
                         .client_id = "fleet-load",
                         .user = argv[4],
                         .password = argv[5]},
                        {.topics = {record::watermark_topic("+")}, .is_kept = false},
                        [&](const mqtt::Message& message) {
                          const auto watermark = record::parse_watermark(message.payload);
                          if (!watermark || watermark->outbox != kOutbox) return;
                          const std::scoped_lock lock{heard.mutex};
                          heard.entries[record::site_of_topic(message.topic)] =
                              watermark->until.entries;
                          heard.changed.notify_one();
                        },
                        [&](bool is_connected, const std::string& why) {
                          if (!why.empty()) std::fprintf(stderr, "%s\n", why.c_str());
                          const std::scoped_lock lock{heard.mutex};
                          heard.is_connected = is_connected;
                          heard.changed.notify_one();
                        })
                        .value();
  {
    std::unique_lock lock{heard.mutex};
    heard.changed.wait(lock, [&] { return heard.is_connected; });
  }
  const auto begin = steady_clock::now();
  const auto elapsed_s = [&] {
    return std::chrono::duration<double>(steady_clock::now() - begin).count();
  };
  std::size_t taken = 0;
  int sent_again = 0;
  for (;;) {
    std::vector<mqtt::Message> messages;
    std::size_t under_way = 0;
    std::size_t done = 0;
    taken = 0;
    {
      const std::scoped_lock lock{heard.mutex};
      for (PlayedSite& site : sites) {
        const auto known = heard.entries.find(site.id);
        if (known != heard.entries.end()) {
          site.confirmed = std::max(site.confirmed, static_cast<std::size_t>(known->second));
        }
        taken += site.confirmed;
        done += site.confirmed >= past.size() ? 1 : 0;
        under_way += site.sent > site.confirmed ? 1 : 0;
      }
    }
    const bool is_over = limit.count() > 0 && elapsed_s() > static_cast<double>(limit.count());
    if (done == sites.size() || is_over) break;
    for (PlayedSite& site : sites) {
      if (site.confirmed >= past.size()) continue;
      const bool is_waiting = site.sent > site.confirmed;
      const bool is_late = is_waiting && steady_clock::now() - site.sent_at > kAgain;
      if (is_waiting ? !is_late : under_way >= at_once) continue;
      under_way += is_waiting ? 0 : 1;
      sent_again += is_late ? 1 : 0;
      messages.push_back(next_batch(site, past));
    }
    if (!messages.empty()) {
      // What the broker did not take is late after a while.
      (void)connection->publish(messages, std::chrono::seconds{20}, {});
      continue;
    }
    std::unique_lock lock{heard.mutex};
    heard.changed.wait_for(lock, std::chrono::milliseconds{200});
  }
  const double wall_s = elapsed_s();
  fmt::print(
      "{{\"sites\": {}, \"entries_a_site\": {}, \"entries\": {}, \"wall_s\": {:.2f}, "
      "\"entries_a_second\": {:.0f}, \"sent_again\": {}}}\n",
      sites.size(), past.size(), taken, wall_s, static_cast<double>(taken) / wall_s, sent_again);
  return 0;
}
