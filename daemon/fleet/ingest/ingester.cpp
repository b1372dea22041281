#include "daemon/fleet/ingest/ingester.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "adapters/mqtt/connection.hpp"
#include "adapters/record/ingest.hpp"
#include "adapters/record/record_batch.hpp"
#include "adapters/record/schema.hpp"
#include "adapters/record/sites.hpp"
#include "core/text/limited.hpp"
#include "daemon/fleet/config/open_record.hpp"
#include "daemon/gateway/forward/open_broker.hpp"

namespace recald::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr milliseconds kLookForBatches{500};
constexpr seconds kAnswerMax{20};
constexpr std::size_t kAtOnce = 32;  ///< Batches between two rounds of telling their gateways.
constexpr std::size_t kWaiting_bytes_max = 64 * 1024 * 1024;
constexpr std::chrono::minutes kReportRefusalsEvery{10};
constexpr std::size_t kReason_max = 300;
constexpr int kReasons_max = 20;              // of a site, in that time
constexpr std::size_t kRefused_max = 10'000;  // of all: a topic may name any site

/// What has arrived and is not committed. It is no promise to anybody: what does not fit is
/// dropped, and its gateway sends it again.
class Arrivals {
 public:
  void push(const mqtt::Message& message) {
    const std::scoped_lock lock{mutex_};
    if (bytes_ + bytes_of(message) > kWaiting_bytes_max) return;
    bytes_ += bytes_of(message);
    waiting_.push_back(message);
    changed_.notify_one();
  }

  void connected() {
    const std::scoped_lock lock{mutex_};
    is_new_connection_ = true;
    changed_.notify_one();
  }

  /// Whether the connection was made since the last call.
  [[nodiscard]] bool is_new_connection() {
    const std::scoped_lock lock{mutex_};
    return std::exchange(is_new_connection_, false);
  }

  /// Waits a moment for the first.
  [[nodiscard]] std::vector<mqtt::Message> take() {
    std::unique_lock lock{mutex_};
    changed_.wait_for(lock, kLookForBatches,
                      [&] { return !waiting_.empty() || is_new_connection_; });
    std::vector<mqtt::Message> taken;
    while (!waiting_.empty() && taken.size() < kAtOnce) {
      bytes_ -= bytes_of(waiting_.front());
      taken.push_back(std::move(waiting_.front()));
      waiting_.pop_front();
    }
    return taken;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<mqtt::Message> waiting_;
  std::size_t bytes_ = 0;
  bool is_new_connection_ = false;
};

mqtt::Message watermark_message(const std::string& site, const record::Watermark& watermark) {
  return {.topic = record::watermark_topic(site),
          .payload = record::to_json(watermark),
          .is_retained = true};
}

bool is_less(const record::Progress& has, const record::Progress& wanted) {
  return has.entries < wanted.entries || has.events < wanted.events || has.results < wanted.results;
}

metering::Instant time_of_arrival() {
  return std::chrono::floor<seconds>(std::chrono::system_clock::now());
}

class Ingester {
 public:
  Ingester(const BrokerConfig& broker, const Report& report, const std::stop_token& stop,
           IngestCounts& counts)
      : broker_(broker), notify_(report), stop_(stop), counts_(counts) {}

  /// Takes batches until a stop is requested. @return or why the record or the broker cannot go on.
  Result<void> serve(postgres::Connection& record) {
    if (auto checked = record::check_schema(record); !checked) return checked;
    Arrivals arrivals;
    auto connection = TRY(open_broker(
        broker_,
        {.will = {},
         .birth = {},
         .topics = {"$share/recald/" + record::batch_topic("+")},
         .is_kept = false},
        [&](const mqtt::Message& message) { arrivals.push(message); },
        [&](bool is_connected, const std::string& why) {
          if (is_connected && why.empty()) arrivals.connected();
          if (!why.empty()) notify_(why);
        }));
    notify_("the record is there: batches of gateways are taken");
    while (!stop_.stop_requested()) {
      if (arrivals.is_new_connection()) {
        if (auto done = notify_all(record, *connection); !done) return done;
      }
      std::vector<mqtt::Message> answers;
      for (const mqtt::Message& message : arrivals.take()) {
        auto answer = TRY(take_safely(record, message));
        if (!answer.topic.empty()) answers.push_back(std::move(answer));
      }
      publish(*connection, answers);
    }
    return {};
  }

 private:
  /// Everything that was retained may be gone, and gateways may wait for a word.
  Result<void> notify_all(postgres::Connection& record, mqtt::Connection& connection) {
    const auto all = TRY(record::watermarks(record));
    std::vector<mqtt::Message> messages;
    for (const auto& [site, watermark] : all)
      messages.push_back(watermark_message(site, watermark));
    publish(connection, messages);
    return {};
  }

  /// What is not told now is told with the next batch, which the gateway sends again.
  void publish(mqtt::Connection& connection, const std::vector<mqtt::Message>& messages) {
    if (messages.empty()) return;
    if (auto sent = connection.publish(messages, kAnswerMax, stop_); !sent) {
      refuse("", "watermarks cannot be told: " + sent.error().message);
    }
  }

  /// An exception is the reason why a batch is refused.
  Result<mqtt::Message> take_safely(postgres::Connection& record, const mqtt::Message& message) {
    try {
      return take(record, message);
    } catch (const std::exception& thrown) {
      ++counts_.refused;
      refuse(message.topic,
             fmt::format("a message on {} is not taken: {}", message.topic, thrown.what()));
      return mqtt::Message{};
    }
  }

  /// @return the watermark to tell, without a topic where the batch is refused; or io_failed: the
  ///         record is away.
  Result<mqtt::Message> take(postgres::Connection& record, const mqtt::Message& message) {
    const std::string site = record::site_of_topic(message.topic);
    const auto batch = record::parse_batch(message.payload);
    if (site.empty() || !batch) {
      ++counts_.refused;
      refuse(site, fmt::format("a message on {} is no batch: {}", message.topic,
                               batch ? "its topic names no site" : batch.error().message));
      return mqtt::Message{};
    }
    const auto watermark = record::take(record, site, *batch, time_of_arrival());
    if (watermark && is_less(watermark->until, batch->after)) {
      ++counts_.refused;
      refuse(site,
             fmt::format("the record has less of site '{}' than its gateway was told, as after "
                         "a backup was restored: the gateway sends everything again",
                         site));
      return watermark_message(site, *watermark);
    }
    if (watermark) {
      ++counts_.batches;
      counts_.entries += static_cast<std::int64_t>(batch->entries.size());
      return watermark_message(site, *watermark);
    }
    if (watermark.error().code == ErrorCode::io_failed) return tl::unexpected(watermark.error());
    ++counts_.refused;
    refuse(site,
           fmt::format("a batch of site '{}' is not taken: {}", site, watermark.error().message));
    return mqtt::Message{};
  }

  /// Each reason of a site once in a while: the second must not hide behind the first.
  void refuse(const std::string& site, const std::string& why) {
    const auto moment = steady_clock::now();
    std::erase_if(refused_,
                  [&](const auto& one) { return moment - one.second >= kReportRefusalsEvery; });
    // Numbers in a sentence change from one batch to the next, and are the same reason.
    std::string reason = limited(why, kReason_max);
    std::erase_if(reason, [](char c) { return c >= '0' && c <= '9'; });
    const auto of_site =
        std::ranges::count_if(refused_, [&](const auto& one) { return one.first.first == site; });
    if (of_site >= kReasons_max || refused_.size() >= kRefused_max) return;
    if (!refused_.try_emplace({site, reason}, moment).second) return;
    notify_(why);
  }

  const BrokerConfig& broker_;
  const Report& notify_;
  const std::stop_token& stop_;
  IngestCounts& counts_;
  std::map<std::pair<std::string, std::string>, steady_clock::time_point> refused_;
};

}  // namespace

IngestCounts ingest(const RecordConfig& record, const BrokerConfig& broker, const Report& report,
                    const std::stop_token& stop) {
  IngestCounts counts;
  Ingester ingester{broker, report, stop, counts};
  keep_trying(
      "no batches are taken, and gateways keep what they have",
      [&]() -> Result<void> {
        auto connection = TRY(open_record(record, {.stop = stop}));
        return ingester.serve(*connection);
      },
      report, stop);
  return counts;
}

}  // namespace recald::daemon
