/// A device that answers each request as a script says: in time or late, whole or in pieces, right
/// or wrong. Real sockets and pseudo-terminals; nothing of it knows Modbus.
#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace recald::testing {

using Bytes = std::vector<std::uint8_t>;

/// What is sent after a wait; without bytes, the connection is closed.
struct Piece {
  std::chrono::milliseconds after{0};
  Bytes bytes;
};

/// @param request  What one read of the descriptor gave: one request, as ours are sent whole.
/// @param number   Of the request, from 0 on, over all connections.
using Script = std::function<std::vector<Piece>(const Bytes& request, int number)>;

/// Serves one descriptor after the other until it goes away.
class ScriptedDevice {
 public:
  explicit ScriptedDevice(Script script) : script_(std::move(script)) {}
  ScriptedDevice(const ScriptedDevice&) = delete;
  ScriptedDevice& operator=(const ScriptedDevice&) = delete;

  [[nodiscard]] int requests() const { return requests_; }
  [[nodiscard]] int connections() const { return connections_; }

  /// Waits until the script of that many requests has been played to its end: all is sent, and
  /// closed where it closes.
  void wait_until_played(int requests) const {
    for (int played = played_; played < requests; played = played_) played_.wait(played);
  }

 protected:
  ~ScriptedDevice() = default;

  void serve(int descriptor) {
    ++connections_;
    while (!stopping_) {
      pollfd waiting{descriptor, POLLIN, 0};
      if (::poll(&waiting, 1, 10) <= 0) continue;
      Bytes request(512);
      const auto count = ::read(descriptor, request.data(), request.size());
      if (count <= 0) return;
      request.resize(static_cast<std::size_t>(count));
      const bool goes_on = answer(descriptor, request);
      if (!goes_on) ::shutdown(descriptor, SHUT_RDWR);
      ++played_;
      played_.notify_all();
      if (!goes_on) return;
    }
  }

  std::atomic<bool> stopping_{false};

 private:
  bool answer(int descriptor, const Bytes& request) {
    for (const Piece& piece : script_(request, requests_++)) {
      for (auto left = piece.after; left.count() > 0 && !stopping_; left -= kStep) {
        std::this_thread::sleep_for(std::min(left, kStep));
      }
      if (piece.bytes.empty()) return false;
      if (!put(descriptor, piece.bytes)) return false;
    }
    return true;
  }

  /// A caller who went away is no reason to end the process by SIGPIPE.
  static bool put(int descriptor, const Bytes& bytes) {
    if (::send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL) >= 0) return true;
    return errno == ENOTSOCK && ::write(descriptor, bytes.data(), bytes.size()) >= 0;
  }

  static constexpr std::chrono::milliseconds kStep{10};
  Script script_;
  std::atomic<int> requests_{0};
  std::atomic<int> connections_{0};
  std::atomic<int> played_{0};
};

/// On a free loopback port.
class ScriptedServer : public ScriptedDevice {
 public:
  explicit ScriptedServer(Script script) : ScriptedDevice(std::move(script)) {
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    if (::bind(listener_, generic, size) != 0 || ::listen(listener_, 8) != 0 ||
        ::getsockname(listener_, generic, &size) != 0) {
      throw std::runtime_error("no loopback port");
    }
    port_ = ntohs(address.sin_port);
    thread_ = std::jthread{[this] { accept_all(); }};
  }
  ~ScriptedServer() {
    stopping_ = true;
    thread_.join();
    ::close(listener_);
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  void accept_all() {
    while (!stopping_) {
      pollfd waiting{listener_, POLLIN, 0};
      if (::poll(&waiting, 1, 10) <= 0) continue;
      const int descriptor = ::accept(listener_, nullptr, nullptr);
      if (descriptor < 0) continue;
      serve(descriptor);
      ::close(descriptor);
    }
  }

  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::jthread thread_;
};

/// On a pseudo-terminal.
class ScriptedLine : public ScriptedDevice {
 public:
  explicit ScriptedLine(Script script) : ScriptedDevice(std::move(script)) {
    char name[128] = {};
    if (::openpty(&master_, &slave_, name, nullptr, nullptr) != 0) {
      throw std::runtime_error("no pseudo-terminal");
    }
    termios raw{};
    ::tcgetattr(slave_, &raw);
    ::cfmakeraw(&raw);
    ::tcsetattr(slave_, TCSANOW, &raw);
    device_ = name;
    thread_ = std::jthread{[this] { serve(master_); }};
  }
  ~ScriptedLine() {
    stopping_ = true;
    thread_.join();
    ::close(master_);
    ::close(slave_);
  }

  [[nodiscard]] const std::string& device() const { return device_; }

 private:
  int master_ = -1;
  int slave_ = -1;
  std::string device_;
  std::jthread thread_;
};

}  // namespace recald::testing
