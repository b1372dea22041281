#include "daemon/gateway/forward/record_link.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "daemon/gateway/forward/open_broker.hpp"

namespace recald::daemon {
namespace {

bool covers(const record::Watermark& said, const record::Watermark& wanted) {
  return said.outbox == wanted.outbox && said.until.entries >= wanted.until.entries &&
         said.until.events >= wanted.until.events && said.until.results >= wanted.until.results;
}

}  // namespace

RecordLink::RecordLink(std::string topic, std::shared_ptr<Heard> heard,
                       std::unique_ptr<mqtt::Connection> connection)
    : topic_(std::move(topic)), heard_(std::move(heard)), connection_(std::move(connection)) {}

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
    }
    heard->changed.notify_all();
    on_sign();
  };
  const auto hear_state = [heard, on_state](bool is_connected, const std::string& why) {
    if (!is_connected) {
      const std::scoped_lock lock{heard->mutex};
      ++heard->losses;
      heard->changed.notify_all();
    }
    on_state(is_connected, why);
  };
  auto connection =
      open_broker(broker, {.will = {}, .birth = {}, .topics = {record::watermark_topic(site)}},
                  hear, hear_state);
  if (!connection) return tl::unexpected(connection.error());
  return std::shared_ptr<RecordLink>{
      new RecordLink{record::batch_topic(site), std::move(heard), std::move(*connection)}};
}

Result<void> RecordLink::publish(std::string batch, std::chrono::milliseconds time_max,
                                 const std::stop_token& stop) {
  const std::vector<mqtt::Message> messages{{.topic = topic_, .payload = std::move(batch)}};
  return connection_->publish(messages, time_max, stop);
}

bool RecordLink::wait_for(const record::Watermark& wanted, std::chrono::milliseconds time_max,
                          const std::stop_token& stop) const {
  std::unique_lock lock{heard_->mutex};
  const auto is_confirmed = [&] { return heard_->last && covers(*heard_->last, wanted); };
  // What was on its way when the connection broke may never have arrived.
  const int losses = heard_->losses;
  heard_->changed.wait_for(lock, stop, time_max,
                           [&] { return is_confirmed() || heard_->losses != losses; });
  return is_confirmed();
}

}  // namespace recald::daemon
