/// Modbus read requests and the check of every reply against its request.
///
/// Plain functions on bytes, without sockets and without coroutines, so that they can be fuzzed.
/// libmodbus carries the bytes; it believes replies of other units, protocols and lengths, hence
/// every field is compared here. There is no code that could encode a write.
///
/// @see Modbus Application Protocol V1.1b3, section 6; Modbus over Serial Line V1.02, 2.5.1.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace recald::modbus {

/// The only functions that recald knows.
enum class Function : std::uint8_t { read_holding_registers = 3, read_input_registers = 4 };

inline constexpr int kRegistersMax = 125;  ///< Of one read, by the protocol.

struct ReadRequest {
  std::uint8_t unit;
  Function function;
  std::uint16_t address;  ///< On the wire: base 0.
  std::uint16_t count;    ///< 1…125, and address + count <= 65 536.

  bool operator==(const ReadRequest&) const = default;
};

using Words = std::vector<std::uint16_t>;  ///< Register contents, in order of address.

/// Why a read gave no words.
enum class ReadFault : std::uint8_t {
  timeout,    ///< No complete reply before the deadline.
  refused,    ///< No connection: refused, unreachable, no such port, no such host.
  closed,     ///< The other end closed or reset the connection, or the port went away.
  exception,  ///< The unit, or a gateway for it, answered with an exception code.
  mismatch,   ///< A reply to something else, or one that contradicts itself.
  crc,        ///< RTU: the check sum is wrong.
};

/// "timeout", "refused", … as metrics and logs have it.
[[nodiscard]] std::string_view to_string(ReadFault fault);

struct ReadFailure {
  ReadFault fault;
  std::uint8_t exception_code = 0;  ///< Only with `exception`.
  std::string what;                 ///< For people: what was expected and what came.
};

/// The reply is none to what was asked.
[[nodiscard]] tl::unexpected<ReadFailure> mismatch(std::string what);

using ReadResult = tl::expected<Words, ReadFailure>;

/// Unit, function, address and count: what both transports put their own bytes around.
/// @pre 1 <= count <= 125 and the last address is on the map.
[[nodiscard]] std::array<std::uint8_t, 6> encode_request(const ReadRequest& request);

/// The registers in a whole TCP frame (header of 7 bytes and PDU), if it answers `request`.
///
/// @param transaction  What the request carried.
/// @return mismatch   another transaction, protocol, unit, function or byte count; a length that
///                    is not that of the frame; a frame cut short or with bytes after its end;
///         exception  two bytes, function | 0x80 and the code.
[[nodiscard]] ReadResult check_tcp_reply(std::span<const std::uint8_t> frame,
                                         const ReadRequest& request, std::uint16_t transaction);

/// The registers in a whole RTU frame (unit, PDU, check sum), if it answers `request`.
/// @return as `check_tcp_reply`, and crc where the check sum is wrong.
[[nodiscard]] ReadResult check_rtu_reply(std::span<const std::uint8_t> frame,
                                         const ReadRequest& request);

/// CRC-16 with polynomial 0xA001 (0x8005 reflected) and start value 0xFFFF; low byte goes first.
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> bytes);

/// What exception codes mean, for people: "2, illegal data address".
[[nodiscard]] std::string describe_exception(std::uint8_t code);

}  // namespace recald::modbus
