/// The connection to the record of a fleet: what is sent to it, and what it has confirmed.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "adapters/mqtt/connection.hpp"
#include "adapters/record/record_batch.hpp"
#include "daemon/site/config/broker_config.hpp"

namespace recald::daemon {

class RecordLink {
 public:
  /// On the connection's thread: the record has said how far it is, so it is there.
  using OnSign = std::function<void()>;

  /// Begins to connect. The broker keeps the last watermark, so it comes by itself then.
  /// @param on_state  As of mqtt::Connection.
  /// @return or as open_broker.
  [[nodiscard]] static Result<std::shared_ptr<RecordLink>> open(const BrokerConfig& broker,
                                                                const std::string& site,
                                                                OnSign on_sign,
                                                                mqtt::Connection::OnState on_state);

  /// As mqtt::Connection::publish, on the site's topic. One caller at a time, as of the next.
  [[nodiscard]] Result<void> publish(std::string batch, std::chrono::milliseconds time_max,
                                     const std::stop_token& stop);

  /// Waits until the record has confirmed all of this, or the connection is lost. @return whether
  /// it has.
  [[nodiscard]] bool wait_for(const record::Watermark& wanted, std::chrono::milliseconds time_max,
                              const std::stop_token& stop) const;

  [[nodiscard]] bool is_connected() const { return connection_->is_connected(); }

 private:
  /// What the connection's thread hears.
  struct Heard {
    std::mutex mutex;
    std::condition_variable_any changed;
    std::optional<record::Watermark> last;
    int losses = 0;  ///< Of the connection.
  };

  RecordLink(std::string topic, std::shared_ptr<Heard> heard,
             std::unique_ptr<mqtt::Connection> connection);

  std::string topic_;
  std::shared_ptr<Heard> heard_;
  std::unique_ptr<mqtt::Connection> connection_;
};

}  // namespace recald::daemon
