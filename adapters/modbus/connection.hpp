/// One Modbus endpoint, TCP or serial, used by one thread through libmodbus.
///
/// libmodbus 3.1.6 only transports the bytes. Its own checks accept replies of other units and
/// lengths, after a timeout it matches each reply to the previous request, and its byte timeout
/// restarts with every byte. So we send raw requests and check the replies ourselves (frame.hpp).
/// Any doubt closes a TCP connection, or waits for silence on a serial line before it is used
/// again. The timeout is a deadline for the whole reply.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "adapters/modbus/device_identification.hpp"
#include "adapters/modbus/frame.hpp"

namespace recald::modbus {

using std::chrono::milliseconds;

struct TcpEndpoint {
  std::string host;  ///< Name or address, IPv4 or IPv6.
  std::uint16_t port = 502;
  bool has_rtu_frames = false;  ///< A serial server passes the frames of its line on as they are.
  milliseconds connect_timeout{3000};
  milliseconds connect_delay{0};  ///< Some gateways drop what arrives right after a connect.

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

/// Time on the line for a number of characters, each of 11 bits with start, parity and stop.
[[nodiscard]] std::chrono::microseconds line_time(const SerialPort& port, int characters);

class Connection {
 public:
  explicit Connection(Endpoint endpoint);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Connects if needed, sends the request, waits for the reply and checks it. Blocks up to the
  /// connect timeout plus `timeout`.
  ///
  /// @return refused    no connection, or too many open files for libmodbus to select on one more;
  ///         timeout    no complete reply in time, even if bytes keep trickling in;
  ///         closed     the other end closed the connection;
  ///         otherwise  as check_tcp_reply and check_rtu_reply. Only an exception keeps a TCP
  ///                    connection open.
  [[nodiscard]] ReadResult read(const ReadRequest& request, milliseconds timeout);

  /// Asks the device for its identity; fails as `read` does. Few devices answer and the question
  /// confuses some, so only `recald scan` asks it.
  [[nodiscard]] IdentityResult identify(std::uint8_t unit, milliseconds timeout);

  void close();
  [[nodiscard]] bool is_open() const;

 private:
  struct Context;

  [[nodiscard]] std::optional<ReadFailure> connect();
  [[nodiscard]] ReadResult ask(const ReadRequest& request, milliseconds timeout);
  [[nodiscard]] ReadResult exchange(const ReadRequest& request, milliseconds timeout);
  /// Sends unit and PDU as a frame of either transport.
  [[nodiscard]] bool send(std::span<const std::uint8_t> request);
  [[nodiscard]] ReadResult receive(const ReadRequest& request, milliseconds timeout);
  /// A serial frame over TCP.
  [[nodiscard]] ReadResult receive_rtu(const ReadRequest& request, milliseconds timeout);
  /// Whether a TCP frame answers the newest request, and not one before it.
  [[nodiscard]] bool answers(std::span<const std::uint8_t> frame);
  [[nodiscard]] tl::expected<IdentityPart, ReadFailure> identify_from(std::uint8_t unit,
                                                                      std::uint8_t first_object,
                                                                      milliseconds timeout);
  [[nodiscard]] tl::expected<std::vector<std::uint8_t>, ReadFailure> receive_pdu(
      std::uint8_t unit, milliseconds timeout);
  void recover_from(const ReadFailure& failure, const ReadRequest& request);
  [[nodiscard]] bool is_serial() const { return std::holds_alternative<SerialPort>(endpoint_); }
  /// Whether frames end with a check sum and have no transaction.
  [[nodiscard]] bool has_rtu_frames() const;
  void wait_for_silence();
  void drain();

  Endpoint endpoint_;
  std::unique_ptr<Context> context_;
  std::chrono::steady_clock::time_point line_free_{};  ///< Serial: silence ends here.
  std::optional<ReadRequest> timed_out_;               ///< RTU frames: its reply may still arrive.
  std::uint16_t transaction_;  ///< TCP: of the newest request; also after another connection.
  bool echoes_ = false;        ///< TCP: the device has sent one back. Some always send 0.
};

}  // namespace recald::modbus
