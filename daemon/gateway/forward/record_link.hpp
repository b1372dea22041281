/// The connection to the record of a fleet: what is sent to it, and what it has confirmed.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "adapters/mqtt/connection.hpp"
#include "adapters/record/record_batch.hpp"
#include "daemon/site/config/service/broker_config.hpp"

namespace recald::daemon {

/// Whether a watermark confirms all that another one stands for.
[[nodiscard]] bool covers(const record::Watermark& watermark, const record::Watermark& wanted);

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

  /// A number that no other batch of this process has, and hardly one of another.
  [[nodiscard]] std::int64_t next_question() { return ++question_; }

  /// How often the record has said unasked how far it is: it has just come, and what was on its way
  /// to it may be lost.
  [[nodiscard]] int calls() const;

  /// Waits until the record has confirmed all of `wanted`, has answered its question otherwise, has
  /// called again, or the connection is lost.
  /// @param calls  Those of before.
  /// @return what settled it; nothing: neither came.
  [[nodiscard]] std::optional<record::Watermark> wait_for(const record::Watermark& wanted,
                                                          int calls,
                                                          std::chrono::milliseconds time_max,
                                                          const std::stop_token& stop) const;

  [[nodiscard]] bool is_connected() const { return connection_->is_connected(); }

 private:
  /// What the connection's thread hears.
  struct Heard {
    std::mutex mutex;
    std::condition_variable_any changed;
    std::optional<record::Watermark> last, last_answer;
    int losses = 0;  ///< Of the connection.
    int calls = 0;
  };

  RecordLink(std::string topic, std::shared_ptr<Heard> heard,
             std::unique_ptr<mqtt::Connection> connection);

  std::string topic_;
  std::int64_t question_;
  std::shared_ptr<Heard> heard_;
  std::unique_ptr<mqtt::Connection> connection_;
};

}  // namespace recald::daemon
