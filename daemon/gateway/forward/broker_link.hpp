/// The connection to a broker, shared by those who publish.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <utility>

#include "adapters/mqtt/connection.hpp"

namespace recald::daemon {

class BrokerLink {
 public:
  explicit BrokerLink(std::unique_ptr<mqtt::Connection> connection)
      : connection_(std::move(connection)) {}

  /// As mqtt::Connection::publish, one caller after the other.
  Result<void> publish(std::span<const mqtt::Message> messages, std::chrono::milliseconds time_max,
                       const std::stop_token& stop) {
    const std::scoped_lock lock{mutex_};
    return connection_->publish(messages, time_max, stop);
  }

  [[nodiscard]] bool is_connected() const { return connection_->is_connected(); }

 private:
  std::mutex mutex_;
  std::unique_ptr<mqtt::Connection> connection_;
};

}  // namespace recald::daemon
