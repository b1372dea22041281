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
  /// On the connection's thread; returns soon, does not throw and does not destroy the connection.
  /// The broker is told that the message has arrived after it has returned: a process that ends
  /// meanwhile gets the message again. A payload of more than 1 MiB is dropped, which is told once
  /// a topic; the broker itself drops what is longer than 4 MiB.
  using OnMessage = std::function<void(const Message&)>;
  /// On the connection's thread. Told on each change, and once per cause of failure: `why` is a
  /// sentence that names the broker. Connected and a `why`: the connection is good, but a
  /// subscription or the birth message was refused, or a message was dropped.
  using OnState = std::function<void(bool is_connected, const std::string& why)>;

  /// Begins to connect and does not wait for the broker.
  /// @return or invalid_value: a topic or a host that cannot be; io_failed: a certificate or key
  ///         that cannot be read.
  [[nodiscard]] static Result<std::unique_ptr<Connection>> open(Broker broker, Session session,
                                                                OnMessage on_message,
                                                                OnState on_state);
  /// Says goodbye, so that no will is sent; takes two seconds at most, whatever the broker does.
  /// Waits for a callback that is running; nobody may be in publish(). A look-up of a name or a
  /// connect that nobody answers goes on without us, and ends by itself.
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Publishes all and waits until the broker has acknowledged each. After a failure any of them
  /// may have arrived: the caller sends all of them again. One caller at a time. The broker's word
  /// is that it has the message, not that its disk has.
  /// @return or io_failed: not connected, connection lost, time out, or a message refused for now;
  ///         unsupported: a message refused for good, such as one on a topic that is not allowed
  ///         (it is named, with the broker's reason); invalid_value: a topic that cannot be;
  ///         out_of_range: a message is longer than the broker takes; cancelled.
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
