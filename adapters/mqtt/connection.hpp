/// A connection to a broker of MQTT 5, on a thread of its own.
///
/// Wraps libmosquitto. Whatever is published has QoS 1. The connection is made again for ever, 1 s
/// to 60 s apart. The broker keeps the session for a day, with what was sent to its topics
/// meanwhile.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <thread>

#include "adapters/mqtt/message.hpp"
#include "core/result.hpp"

namespace recald::mqtt {

class Connection {
 public:
  /// On the connection's thread; it should return soon and must not destroy the connection.
  using OnMessage = std::function<void(const Message&)>;
  /// On the connection's thread. Told on each change, and once per cause of failure: `why` is a
  /// sentence that names the broker.
  using OnState = std::function<void(bool is_connected, const std::string& why)>;

  /// Begins to connect and does not wait for the broker.
  /// @return or invalid_value: a topic or a host that cannot be; io_failed: a certificate or key
  ///         that cannot be read.
  [[nodiscard]] static Result<std::unique_ptr<Connection>> open(Broker broker, Session session,
                                                                OnMessage on_message,
                                                                OnState on_state);
  /// Says goodbye, so that no will is sent; takes a second or two at most, whatever the broker
  /// does.
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Publishes all and waits until the broker has acknowledged each. After a failure any of them
  /// may have arrived: the caller sends all of them again. One caller at a time.
  /// @return or io_failed: not connected, connection lost, a message refused (the first is named,
  /// with
  ///         the broker's reason), or time out; invalid_value: a topic that cannot be; cancelled.
  [[nodiscard]] Result<void> publish(std::span<const Message> messages,
                                     std::chrono::milliseconds time_max,
                                     const std::stop_token& stop);

  [[nodiscard]] bool is_connected() const;

 private:
  class Client;
  explicit Connection(std::shared_ptr<Client> client);

  std::shared_ptr<Client> client_;
  std::thread thread_;
};

}  // namespace recald::mqtt
