/// Modbus read requests, and the check of every reply against its request.
///
/// Plain functions on bytes, without sockets and coroutines, so that they can be fuzzed. libmodbus
/// accepts replies of other units, protocols and lengths, so we compare every field here. No code
/// here can encode a write.
///
/// @see Modbus Application Protocol V1.1b3, section 6; Modbus over Serial Line V1.02, 2.5.1.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "adapters/ports/register_read.hpp"

namespace recald::modbus {

/// The reply does not answer the request.
[[nodiscard]] tl::unexpected<ReadFailure> mismatch(std::string what);

/// Unit, function, address and count, to which both transports add their own bytes.
/// @pre 1 <= count <= 125 and the last address is on the map.
[[nodiscard]] std::array<std::uint8_t, 6> encode_request(const ReadRequest& request);

/// The registers in a whole TCP frame (header of 7 bytes and PDU), if it answers `request`.
///
/// @param transaction  The one in the request.
/// @return mismatch   another transaction, protocol, unit, function or byte count; a length field
///         that does not fit the frame; a frame that is cut short or too long;
///         exception  two bytes, function | 0x80 and the code.
[[nodiscard]] ReadResult check_tcp_reply(std::span<const std::uint8_t> frame,
                                         const ReadRequest& request, std::uint16_t transaction);

/// The registers in a whole RTU frame (unit, PDU, checksum), if it answers `request`.
/// @return as `check_tcp_reply`, and crc if the checksum is wrong.
[[nodiscard]] ReadResult check_rtu_reply(std::span<const std::uint8_t> frame,
                                         const ReadRequest& request);

/// CRC-16 with polynomial 0xA001 (0x8005 reflected) and start value 0xFFFF; low byte goes first.
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> bytes);

/// An exception code in words: "2 (illegal data address)".
[[nodiscard]] std::string describe_exception(std::uint8_t code);

/// Exceptions 5 and 6: the unit is busy; the same request may work a moment later.
[[nodiscard]] bool is_busy(std::uint8_t exception);

/// Exceptions 10 and 11: a gateway answered because the unit did not.
[[nodiscard]] bool is_from_gateway(std::uint8_t exception);

/// Exceptions 2 and 3: the unit does not have some of the registers, or not so many of them.
[[nodiscard]] bool is_illegal_span(const ReadFailure& failure);

/// Whether the unit itself refused to serve this request.
[[nodiscard]] bool is_refusal(const ReadFailure& failure);

}  // namespace recald::modbus
