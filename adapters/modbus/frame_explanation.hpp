/// Explains byte by byte a Modbus frame from a log or a terminal.
///
/// Unlike the checks of frame.hpp, this does not know the request: it describes the frame and names
/// every fault. Plain functions on bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/modbus/frame.hpp"
#include "core/result.hpp"

namespace recald::modbus {

enum class Framing : std::uint8_t {
  tcp,        ///< Header of 7 bytes, then the PDU.
  rtu,        ///< Unit, PDU, checksum.
  registers,  ///< Register contents alone.
};

[[nodiscard]] std::string_view to_string(Framing framing);
[[nodiscard]] Result<Framing> parse_framing(std::string_view text);

/// A few bytes of a frame with one meaning.
struct FramePart {
  std::size_t begin;  ///< Offset of the first byte.
  std::size_t size;
  std::string meaning;  ///< "unit 1"
};

struct FrameExplanation {
  Framing framing = Framing::registers;
  std::vector<FramePart> parts;  ///< In order; they cover all bytes except those of registers.
  std::optional<std::uint16_t> transaction;
  std::optional<std::uint8_t> unit;
  std::optional<std::uint8_t> function;        ///< As requested, without the exception bit.
  std::optional<std::uint8_t> exception_code;  ///< The unit refused.
  std::size_t registers_begin = 0;             ///< Offset of the first register's high byte.
  Words registers;
  std::vector<std::string> problems;  ///< Sentences; empty: a good reply.
};

/// Bytes from text as people copy it: "01 03 04", "0x01,0x03", "010304", "01:03:04".
/// @return invalid_value  a character that is not a hexadecimal digit, half a byte, nothing at all.
[[nodiscard]] Result<std::vector<std::uint8_t>> parse_hex_bytes(std::string_view text);

/// Explains a reply as far as it can be understood.
///
/// TCP is recognised by protocol 0 and a fitting length, RTU by its checksum, a damaged frame by
/// the function code in the place where either has it. Anything else is treated as bare registers.
/// @param as  The kind of frame, if known; then nothing is guessed.
[[nodiscard]] FrameExplanation explain_reply(std::span<const std::uint8_t> frame,
                                             std::optional<Framing> as = {});

struct FramedRequest {
  Framing framing;
  ReadRequest request;
  std::uint16_t transaction = 0;
};

/// A read request: 12 bytes of TCP or 8 of RTU.
/// @return malformed  any other length, function, protocol, check sum or number of registers.
[[nodiscard]] Result<FramedRequest> parse_request(std::span<const std::uint8_t> frame);

}  // namespace recald::modbus
