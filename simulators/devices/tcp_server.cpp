#include <fmt/format.h>

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <set>

#include "simulators/devices/device_connection.hpp"
#include "simulators/devices/device_server.hpp"

namespace recald::simulators {
namespace {

using boost::asio::ip::tcp;
using Error = boost::system::error_code;
using Connection = DeviceConnection<tcp::socket>;

class TcpServer final : public DeviceServer {
 public:
  TcpServer(boost::asio::io_context& loop, EndpointPlan plan, const metering::TrialClock& clock)
      : acceptor_(loop),
        refusal_change_(loop),
        clock_(clock),
        port_(plan.port),
        single_connection_(plan.single_connection),
        endpoint_(Transport::tcp, std::move(plan.devices), std::move(plan.faults), clock.start) {}

  /// Takes the port even if the script starts with a refusal, because its number must be known.
  Error open() {
    if (const Error error = listen()) return error;
    follow_script();
    return {};
  }

  [[nodiscard]] std::string address() const override { return fmt::format("127.0.0.1:{}", port_); }
  [[nodiscard]] const DeviceEndpoint& endpoint() const override { return endpoint_; }

 private:
  Error listen() {
    const tcp::endpoint where{boost::asio::ip::address_v4::loopback(), port_};
    Error error;
    if (acceptor_.open(where.protocol(), error)) return error;
    acceptor_.set_option(tcp::acceptor::reuse_address{true}, error);
    if (acceptor_.bind(where, error) || acceptor_.listen(64, error)) {
      acceptor_.close();
      return error;
    }
    port_ = acceptor_.local_endpoint().port();
    accept();
    return {};
  }

  void accept() {
    acceptor_.async_accept([this](const Error& error, tcp::socket socket) {
      if (error == boost::asio::error::operation_aborted) return;
      if (!error) serve(std::move(socket));
      if (acceptor_.is_open()) accept();
    });
  }

  void serve(tcp::socket socket) {
    if (endpoint_.refuses(simulated_now(clock_))) return;  // the client connected just before
    Error ignored;
    socket.set_option(tcp::no_delay{true}, ignored);
    auto connection = std::make_shared<Connection>(std::move(socket), endpoint_, clock_, [this] {
      // Runs while a connection is closing; expired ones are dropped on the way.
      std::erase_if(connections_, [](const auto& each) { return each.expired(); });
      --clients_;
      listen_again();
    });
    connections_.push_back(connection);
    ++clients_;
    // A port without a listener refuses connections, as such devices do.
    if (single_connection_) acceptor_.close();
    connection->start();
  }

  void listen_again() {
    const bool is_free = !single_connection_ || clients_ == 0;
    // If another program has taken the port meanwhile, the device stays down.
    if (is_free && !acceptor_.is_open() && !endpoint_.refuses(simulated_now(clock_))) {
      (void)listen();
    }
  }

  void follow_script() {
    const SimulatedTime now = simulated_now(clock_);
    if (endpoint_.refuses(now)) {
      acceptor_.close();
      const auto connections = connections_;
      for (const auto& each : connections) {
        if (const auto connection = each.lock()) connection->close();
      }
    } else {
      listen_again();
    }
    const auto change = endpoint_.next_refusal_change(now);
    if (!change) return;
    refusal_change_.expires_after(clock_.real_wait(*change - now));
    refusal_change_.async_wait([this](const Error& error) {
      if (!error) follow_script();
    });
  }

  tcp::acceptor acceptor_;
  boost::asio::steady_timer refusal_change_;
  const metering::TrialClock& clock_;
  std::uint16_t port_;
  bool single_connection_;
  DeviceEndpoint endpoint_;
  std::vector<std::weak_ptr<Connection>> connections_;
  int clients_ = 0;
};

}  // namespace

Result<std::unique_ptr<DeviceServer>> open_tcp_server(boost::asio::io_context& loop,
                                                      EndpointPlan plan,
                                                      const metering::TrialClock& clock) {
  const auto port = plan.port;
  auto server = std::make_unique<TcpServer>(loop, std::move(plan), clock);
  if (const Error error = server->open()) {
    return failure(ErrorCode::io_failed, fmt::format("cannot listen on 127.0.0.1:{} ({}); choose "
                                                     "another port, or 0 for any that is free",
                                                     port, error.message()));
  }
  return server;
}

}  // namespace recald::simulators
