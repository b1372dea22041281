#include "daemon/gateway/forward/record_link.hpp"

#include <fmt/format.h>

#include <random>
#include <utility>
#include <vector>

#include "daemon/gateway/forward/open_broker.hpp"

namespace recald::daemon {
namespace {

/// Far from where counting on from it would overflow.
std::int64_t random_number() {
  std::random_device random;
  return std::uniform_int_distribution<std::int64_t>{1, std::int64_t{1} << 61}(random);
}

}  // namespace

bool covers(const record::Watermark& watermark, const record::Watermark& wanted) {
  return watermark.outbox == wanted.outbox && watermark.until.entries >= wanted.until.entries &&
         watermark.until.events >= wanted.until.events &&
         watermark.until.results >= wanted.until.results;
}

RecordLink::RecordLink(std::string topic, std::shared_ptr<Heard> heard,
                       std::unique_ptr<mqtt::Connection> connection)
    : topic_(std::move(topic)),
      question_(random_number()),
      heard_(std::move(heard)),
      connection_(std::move(connection)) {}

Result<std::shared_ptr<RecordLink>> RecordLink::open(const BrokerConfig& broker,
                                                     const std::string& site, OnSign on_sign,
                                                     mqtt::Connection::OnState on_state) {
  auto heard = std::make_shared<Heard>();
  const auto hear = [heard, on_sign = std::move(on_sign), on_state](const mqtt::Message& message) {
    if (message.payload.empty()) return;  // somebody has removed the one that the broker kept
    const auto watermark = record::parse_watermark(message.payload);
    if (!watermark) {
      return on_state(true, fmt::format("{}: {}", message.topic, watermark.error().message));
    }
    {
      const std::scoped_lock lock{heard->mutex};
      heard->last = *watermark;
      if (watermark->answers != 0) {
        heard->last_answer = *watermark;
      } else {
        ++heard->calls;
      }
    }
    heard->changed.notify_all();
    on_sign();
  };
  const auto on_broker_state = [heard, on_state](bool is_connected, const std::string& why) {
    if (!is_connected) {
      const std::scoped_lock lock{heard->mutex};
      ++heard->losses;
      heard->changed.notify_all();
    }
    on_state(is_connected, why);
  };
  auto connection =
      TRY(open_broker(broker, {.will = {}, .birth = {}, .topics = {record::watermark_topic(site)}},
                      hear, on_broker_state));
  return std::shared_ptr<RecordLink>{
      new RecordLink{record::batch_topic(site), std::move(heard), std::move(connection)}};
}

Result<void> RecordLink::publish(std::string batch, std::chrono::milliseconds time_max,
                                 const std::stop_token& stop) {
  const std::vector<mqtt::Message> messages{{.topic = topic_, .payload = std::move(batch)}};
  return connection_->publish(messages, time_max, stop);
}

int RecordLink::calls() const {
  const std::scoped_lock lock{heard_->mutex};
  return heard_->calls;
}

std::optional<record::Watermark> RecordLink::wait_for(const record::Watermark& wanted, int calls,
                                                      std::chrono::milliseconds time_max,
                                                      const std::stop_token& stop) const {
  std::unique_lock lock{heard_->mutex};
  std::optional<record::Watermark> settled;
  // What was on its way when the connection broke may never have arrived.
  const int losses = heard_->losses;
  heard_->changed.wait_for(lock, stop, time_max, [&] {
    const Heard& heard = *heard_;
    const auto& answer = heard.last_answer;
    if (heard.last && covers(*heard.last, wanted)) {
      settled = heard.last;
    } else if (wanted.answers != 0 && answer && answer->answers == wanted.answers) {
      settled = answer;
    }
    return settled || heard.losses != losses || heard.calls != calls;
  });
  return settled;
}

}  // namespace recald::daemon
