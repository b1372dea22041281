/// A network between a program and a server of a test's that can be cut: connections stay open, and
/// nothing passes.
#pragma once

#include <poll.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/loopback.hpp"

namespace recald::testing {

/// On loopback, for TCP.
class DroppingProxy {
 public:
  /// Passes everything on to this port.
  explicit DroppingProxy(std::uint16_t to) : to_{to} {
    if (port_ == 0 || ::listen(listener_, 50) != 0) {
      throw std::runtime_error("the proxy cannot listen");
    }
    thread_ = std::jthread{[this](const std::stop_token& stop) { serve(stop); }};
  }
  ~DroppingProxy() {
    thread_.request_stop();
    thread_.join();
    close_all();
    ::close(listener_);
  }
  DroppingProxy(const DroppingProxy&) = delete;
  DroppingProxy& operator=(const DroppingProxy&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }

  void cut() { state_ = State::cut; }
  /// Connections of before go on with what they have kept.
  void mend() { state_ = State::open; }
  /// They are reset, as by a router that has forgotten them.
  void mend_and_reset() { state_ = State::reset; }

 private:
  enum class State : std::uint8_t { open, cut, reset };
  struct Pair {
    int client, server;
  };

  void serve(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (state_ == State::reset) {
        close_all();
        state_ = State::open;
      }
      std::vector<::pollfd> waits;
      if (state_ == State::open) {
        waits.push_back({listener_, POLLIN, 0});
        for (const Pair& pair : pairs_) {
          waits.push_back({pair.client, POLLIN, 0});
          waits.push_back({pair.server, POLLIN, 0});
        }
      }
      if (::poll(waits.data(), waits.size(), 20) <= 0 || state_ != State::open) continue;
      for (std::size_t i = pairs_.size(); i-- > 0;) {
        const auto [client, server] = pairs_[i];
        const bool is_open =
            pass(waits[1 + 2 * i], client, server) && pass(waits[2 + 2 * i], server, client);
        if (is_open) continue;
        ::close(client);
        ::close(server);
        pairs_.erase(pairs_.begin() + static_cast<std::ptrdiff_t>(i));
      }
      if (waits.front().revents != 0) accept();
    }
  }

  void accept() {
    const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (client < 0) return;
    const int server = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const ::sockaddr_in address = loopback(to_);
    if (::connect(server, reinterpret_cast<const ::sockaddr*>(&address), sizeof address) == 0) {
      pairs_.push_back({client, server});
      return;
    }
    ::close(client);
    ::close(server);
  }

  /// @return whether the connection goes on.
  static bool pass(const ::pollfd& wait, int from, int to) {
    if (wait.revents == 0) return true;
    std::array<char, 65'536> bytes;
    const ::ssize_t count = ::recv(from, bytes.data(), bytes.size(), 0);
    for (::ssize_t sent = 0; sent < count;) {
      const auto done =
          ::send(to, bytes.data() + sent, static_cast<std::size_t>(count - sent), MSG_NOSIGNAL);
      if (done <= 0) return false;
      sent += done;
    }
    return count > 0;
  }

  void close_all() {
    for (const auto& [client, server] : pairs_) {
      const ::linger at_once{1, 0};
      ::setsockopt(client, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
      ::setsockopt(server, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
      ::close(client);
      ::close(server);
    }
    pairs_.clear();
  }

  std::uint16_t to_;
  int listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  std::uint16_t port_ = bind_to_free_port(listener_);
  std::atomic<State> state_ = State::open;
  std::vector<Pair> pairs_;  ///< Of the thread.
  std::jthread thread_;
};

}  // namespace recald::testing
