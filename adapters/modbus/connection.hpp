/// One Modbus endpoint, TCP or serial, spoken to by one thread through libmodbus.
///
/// libmodbus 3.1.6 carries the bytes and nothing else: its own checks pass replies of other units
/// and lengths, after a timeout it hands out each reply to the request before it, and its byte
/// timeout starts anew with every byte. So requests go out raw, replies are checked by us
/// (frame.hpp), every doubt ends a TCP connection and silences a serial line before it is used
/// again, and the timeout is a deadline for the whole reply.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "adapters/modbus/device_identification.hpp"
#include "adapters/modbus/frame.hpp"

namespace recald::modbus {

using std::chrono::milliseconds;

struct TcpEndpoint {
  std::string host;  ///< Name or address, IPv4 or IPv6.
  std::uint16_t port = 502;
  milliseconds connect_timeout{3000};
  milliseconds connect_delay{0};  ///< Some gateways drop what comes right after a connect.

  bool operator==(const TcpEndpoint&) const = default;
};

enum class Parity : char { none = 'N', even = 'E', odd = 'O' };

struct SerialPort {
  std::string device;  ///< "/dev/ttyUSB0"
  int baud = 9600;
  int data_bits = 8;
  Parity parity = Parity::even;
  int stop_bits = 1;

  bool operator==(const SerialPort&) const = default;
};

using Endpoint = std::variant<TcpEndpoint, SerialPort>;

/// "10.20.0.15:502", "/dev/ttyUSB0".
[[nodiscard]] std::string to_string(const Endpoint& endpoint);

/// Time that a number of characters takes on the line; one has 11 bits with start, parity and stop.
[[nodiscard]] std::chrono::microseconds line_time(const SerialPort& port, int characters);

class Connection {
 public:
  explicit Connection(Endpoint endpoint);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Connects if need be, asks, waits, checks. Blocks up to the connect timeout and `timeout`.
  ///
  /// @return refused    no connection, or so many open files that libmodbus could not select on
  /// one;
  ///         timeout    no complete reply in time, however its bytes drip;
  ///         closed     the other end went away;
  ///         otherwise  as check_tcp_reply and check_rtu_reply. Only an exception keeps a TCP
  ///                    connection open.
  [[nodiscard]] ReadResult read(const ReadRequest& request, milliseconds timeout);

  /// Asks what the device is; failures as with `read`. Few devices answer, and some are confused by
  /// the question, so that only `recald scan` asks it.
  [[nodiscard]] IdentityResult identify(std::uint8_t unit, milliseconds timeout);

  void close();
  [[nodiscard]] bool is_open() const;

 private:
  struct Context;

  [[nodiscard]] std::optional<ReadFailure> connect();
  [[nodiscard]] ReadResult ask(const ReadRequest& request, milliseconds timeout);
  [[nodiscard]] ReadResult exchange(const ReadRequest& request, milliseconds timeout);
  [[nodiscard]] ReadResult receive(const ReadRequest& request);
  [[nodiscard]] tl::expected<IdentityPart, ReadFailure> identify_from(std::uint8_t unit,
                                                                      std::uint8_t first_object,
                                                                      milliseconds timeout);
  [[nodiscard]] tl::expected<std::vector<std::uint8_t>, ReadFailure> receive_pdu(
      std::uint8_t unit, milliseconds timeout);
  void recover_from(const ReadFailure& failure, const ReadRequest& request);
  [[nodiscard]] bool is_serial() const { return std::holds_alternative<SerialPort>(endpoint_); }
  void wait_for_silence();
  void drain();

  Endpoint endpoint_;
  std::unique_ptr<Context> context_;
  std::chrono::steady_clock::time_point line_free_{};  ///< Serial: silence ends here.
  std::optional<ReadRequest> timed_out_;               ///< Serial: its reply may still come.
};

}  // namespace recald::modbus
