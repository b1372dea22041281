/// A client that sends whatever bytes a test likes, and a server to send them to.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <future>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

#include "adapters/http/server.hpp"

namespace recald::testing {

/// One connection to a loopback port.
class RawClient {
 public:
  explicit RawClient(std::uint16_t port) {
    descriptor_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    if (::connect(descriptor_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("no connection");
    }
  }
  ~RawClient() { ::close(descriptor_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  void send(std::string_view bytes) {
    while (!bytes.empty()) {
      const auto sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return;  // cut off: what was answered shows it
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
  }

  /// Head and body of the next answer, by its Content-Length; what there was if the server ends.
  std::string answer() {
    std::size_t head = 0;
    while ((head = received_.find("\r\n\r\n")) == std::string::npos && receive()) continue;
    if (head == std::string::npos) return std::exchange(received_, {});
    const std::size_t length = head + 4 + content_length(received_.substr(0, head));
    while (received_.size() < length && receive()) continue;
    std::string whole = received_.substr(0, length);
    received_.erase(0, whole.size());
    return whole;
  }

  /// All that comes until the server ends.
  std::string everything() {
    while (receive()) continue;
    return std::exchange(received_, {});
  }

 private:
  static std::size_t content_length(const std::string& head) {
    const std::size_t at = head.find("Content-Length: ");
    return at == std::string::npos ? 0 : std::stoul(head.substr(at + 16));
  }
  /// @return false at the end. Half a minute without a byte is a server that hangs.
  bool receive() {
    pollfd waiting{descriptor_, POLLIN, 0};
    if (::poll(&waiting, 1, 30'000) <= 0) throw std::runtime_error("no answer, and no end");
    char bytes[65536];
    const auto count = ::recv(descriptor_, bytes, sizeof bytes, 0);
    if (count <= 0) return false;
    received_.append(bytes, static_cast<std::size_t>(count));
    return true;
  }

  int descriptor_ = -1;
  std::string received_;
};

/// A server on a free loopback port, with a thread for its loop.
class RunningServer {
 public:
  explicit RunningServer(http::Handler handler, http::ServerOptions options = {}) {
    options.port = 0;
    auto listening = http::Server::listen(context_, options, std::move(handler));
    if (!listening) throw std::runtime_error(listening.error().message);
    server_ = std::move(*listening);
    port_ = server_->port();
    thread_ = std::jthread{[this] { context_.run(); }};
  }
  ~RunningServer() {
    context_.stop();
    thread_.join();
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }

  /// Does it on the loop's thread, and waits until it is done.
  template <class Call>
  void on_loop(Call call) {
    std::promise<void> done;
    boost::asio::post(context_, [&] {
      call(*server_);
      done.set_value();
    });
    done.get_future().wait();
  }

 private:
  boost::asio::io_context context_{1};
  std::unique_ptr<http::Server> server_;
  std::uint16_t port_ = 0;
  std::jthread thread_;
};

}  // namespace recald::testing
