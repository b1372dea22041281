/// Connections to the brokers of a site file, and the events about them.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "adapters/mqtt/connection.hpp"
#include "adapters/ports/store.hpp"
#include "daemon/site/config/service/broker_config.hpp"

namespace recald::daemon {

/// Begins to connect, with the password as its file has it now. The callbacks are those of
/// mqtt::Connection.
/// @return or the reason, which may go away by itself: a file is not there yet, say.
[[nodiscard]] Result<std::unique_ptr<mqtt::Connection>> open_broker(
    const BrokerConfig& config, mqtt::Session session, mqtt::Connection::OnMessage on_message,
    mqtt::Connection::OnState on_state);

/// Makes events of what becomes of one connection.
class BrokerNews {
 public:
  /// As mqtt::Connection::OnState, or of an attempt to open. @param words  For people: "MQTT broker
  /// at broker.example.org:1883". @return an event without its time; nothing: it was reported
  /// before.
  [[nodiscard]] std::optional<StoreEvent> on_state(const std::string& words, bool is_connected,
                                                   const std::string& why);

 private:
  bool is_lost_ = false;
  std::string lost_why_;
};

}  // namespace recald::daemon
