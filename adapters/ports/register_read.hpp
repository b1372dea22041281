/// One read of registers: the request and its outcome.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace recald::modbus {

/// The only functions that recald uses.
enum class Function : std::uint8_t { read_holding_registers = 3, read_input_registers = 4 };

inline constexpr int kRegistersMax = 125;  ///< Per read, by the protocol.

struct ReadRequest {
  std::uint8_t unit;
  Function function;
  std::uint16_t address;  ///< On the wire: base 0.
  std::uint16_t count;    ///< 1…125, and address + count <= 65 536.

  bool operator==(const ReadRequest&) const = default;
};

using Words = std::vector<std::uint16_t>;  ///< Register contents, in order of address.

/// Why a read returned no words.
enum class ReadFault : std::uint8_t {
  timeout,    ///< No complete reply before the deadline.
  refused,    ///< No connection: refused, unreachable, no such port, no such host.
  closed,     ///< The other end closed or reset the connection, or the port disappeared.
  exception,  ///< The unit, or a gateway for it, answered with an exception code.
  mismatch,   ///< A reply to another request, or one that contradicts itself.
  crc,        ///< RTU: the checksum is wrong.
};

/// "timeout", "refused", … as in metrics and logs.
[[nodiscard]] std::string_view to_string(ReadFault fault);

struct ReadFailure {
  ReadFault fault;
  std::uint8_t exception_code = 0;  ///< Only with `exception`.
  std::string what;                 ///< For people: what was expected and what arrived.
};

using ReadResult = tl::expected<Words, ReadFailure>;

}  // namespace recald::modbus
