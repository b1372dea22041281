/// Bytes of a Modbus frame as its readers see them.
#pragma once

#include <cstdint>
#include <span>

namespace recald::modbus {

using Bytes = std::span<const std::uint8_t>;

/// Set in the function code of an answer that is an exception.
inline constexpr std::uint8_t kExceptionBit = 0x80;

/// Big-endian, as all of Modbus but its check sum.
inline std::uint16_t word_at(Bytes bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

}  // namespace recald::modbus
