/// A connection to a broker of a test, and what it told.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "adapters/mqtt/connection.hpp"
#include "tests/support/background_process.hpp"

namespace recald::mqtt {

inline constexpr std::chrono::milliseconds kPatience{30'000};

inline Broker loopback(std::uint16_t port, std::string client_id = "recald") {
  return {.host = "127.0.0.1", .port = port, .client_id = std::move(client_id)};
}

class Connected {
 public:
  struct State {
    bool is_connected;
    std::string why;
  };

  explicit Connected(const Broker& broker, Session session = {}) {
    auto opened = Connection::open(
        broker, std::move(session),
        [this](const Message& message) {
          const std::scoped_lock lock{mutex_};
          messages_.push_back(message);
        },
        [this](bool is_connected, const std::string& why) {
          const std::scoped_lock lock{mutex_};
          states_.push_back({is_connected, why});
        });
    if (!opened) throw std::runtime_error(opened.error().message);
    connection_ = std::move(*opened);
  }

  Connection& operator*() const { return *connection_; }
  Connection* operator->() const { return connection_.get(); }
  [[nodiscard]] bool is_soon_connected() const {
    return testing::eventually([this] { return connection_->is_connected(); });
  }
  [[nodiscard]] std::vector<Message> messages() const {
    const std::scoped_lock lock{mutex_};
    return messages_;
  }
  [[nodiscard]] std::vector<State> states() const {
    const std::scoped_lock lock{mutex_};
    return states_;
  }
  /// How many states had the words.
  [[nodiscard]] int told(const std::string& words) const {
    int count = 0;
    for (const State& state : states()) count += state.why.find(words) != std::string::npos ? 1 : 0;
    return count;
  }
  /// Whether a state gets the words; a failure says what was told.
  [[nodiscard]] ::testing::AssertionResult is_soon_told(const std::string& words) const {
    if (testing::eventually([&] { return told(words) > 0; })) return ::testing::AssertionSuccess();
    auto not_told = ::testing::AssertionFailure() << "not told: " << words;
    for (const State& state : states()) not_told << "\n" << state.is_connected << ' ' << state.why;
    return not_told;
  }
  Result<void> publish(const std::vector<Message>& messages) const {
    return connection_->publish(messages, kPatience, {});
  }
  void close() { connection_.reset(); }

 private:
  mutable std::mutex mutex_;
  std::vector<Message> messages_;
  std::vector<State> states_;
  std::unique_ptr<Connection> connection_;  ///< Last: it uses all of the above.
};

}  // namespace recald::mqtt
