/// The bytes of a Modbus frame, and how to read them.
#pragma once

#include <cstdint>
#include <span>

namespace recald::modbus {

using Bytes = std::span<const std::uint8_t>;

/// Set in the function code of an exception response.
inline constexpr std::uint8_t kExceptionBit = 0x80;

/// Big-endian, like everything in Modbus except its checksum.
inline std::uint16_t word_at(Bytes bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

}  // namespace recald::modbus
