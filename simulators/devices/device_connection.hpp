/// One client of an endpoint: takes requests and replies, one after the other, as a device would.
#pragma once

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>

#include "core/metering/registers/trial_clock.hpp"
#include "simulators/devices/device_endpoint.hpp"

namespace recald::simulators {

/// The current time of the simulation.
[[nodiscard]] inline SimulatedTime simulated_now(const metering::TrialClock& clock) {
  return clock.simulated(
      std::chrono::floor<std::chrono::microseconds>(std::chrono::system_clock::now()));
}

/// @tparam Stream  A TCP socket, or the descriptor of a pseudo-terminal.
template <class Stream>
class DeviceConnection : public std::enable_shared_from_this<DeviceConnection<Stream>> {
 public:
  /// @param endpoint  Outlives the connection, as does `clock`.
  /// @param closed    Called once, when the client has gone.
  DeviceConnection(Stream stream, DeviceEndpoint& endpoint, const metering::TrialClock& clock,
                   std::function<void()> closed)
      : stream_(std::move(stream)),
        pause_(stream_.get_executor()),
        endpoint_(endpoint),
        clock_(clock),
        closed_(std::move(closed)) {}

  void start() { read(); }

  void close() {
    if (!stream_.is_open()) return;
    boost::system::error_code ignored;
    stream_.close(ignored);
    pause_.cancel();
    outgoing_.clear();
    if (closed_) std::exchange(closed_, nullptr)();
  }

 private:
  using Error = boost::system::error_code;
  using Monotonic = std::chrono::steady_clock;

  void read() {
    stream_.async_read_some(
        boost::asio::buffer(input_),
        [self = this->shared_from_this()](const Error& error, std::size_t count) {
          if (error) return self->close();
          self->take(count);
          if (self->stream_.is_open()) self->read();
        });
  }

  void take(std::size_t count) {
    // On a serial line silence ends a frame: an incomplete one before it is dropped.
    constexpr std::chrono::milliseconds kSilence{50};
    const auto now = Monotonic::now();
    if (endpoint_.transport() == Transport::rtu && now - last_arrival_ > kSilence) {
      received_.clear();
    }
    last_arrival_ = now;
    received_.insert(received_.end(), input_.begin(),
                     input_.begin() + static_cast<std::ptrdiff_t>(count));
    const TakenRequests taken = take_requests(endpoint_.transport(), received_);
    for (const DeviceRequest& request : taken.requests) {
      for (ReplyPiece& piece : endpoint_.answer(request, simulated_now(clock_))) {
        outgoing_.push_back(std::move(piece));
      }
    }
    if (taken.is_garbled && endpoint_.transport() == Transport::tcp) return close();
    if (!is_sending_) send_next();
  }

  void send_next() {
    is_sending_ = !outgoing_.empty();
    if (!is_sending_) return;
    if (outgoing_.front().wait.count() == 0) return write();
    pause_.expires_after(outgoing_.front().wait);
    pause_.async_wait([self = this->shared_from_this()](const Error& error) {
      if (!error && !self->outgoing_.empty()) self->write();
    });
  }

  void write() {
    written_ = std::move(outgoing_.front().bytes);
    outgoing_.pop_front();
    boost::asio::async_write(stream_, boost::asio::buffer(written_),
                             [self = this->shared_from_this()](const Error& error, std::size_t) {
                               if (error) return self->close();
                               self->send_next();
                             });
  }

  Stream stream_;
  boost::asio::steady_timer pause_;
  DeviceEndpoint& endpoint_;
  const metering::TrialClock& clock_;
  std::function<void()> closed_;
  std::array<std::uint8_t, 512> input_{};
  Bytes received_;
  Monotonic::time_point last_arrival_{};
  std::deque<ReplyPiece> outgoing_;
  Bytes written_;  ///< Must live until it is written.
  bool is_sending_ = false;
};

}  // namespace recald::simulators
