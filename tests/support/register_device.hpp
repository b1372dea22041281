/// A Modbus TCP device with registers at some addresses, as a script for `ScriptedServer`: what it
/// has is answered, anything else is refused as an illegal address.
#pragma once

#include <map>

#include "tests/support/scripted_device.hpp"

namespace recald::testing {

using Registers = std::map<int, std::uint16_t>;  ///< Address on the wire -> content.

inline void put_words(Registers& registers, int address, const std::vector<std::uint16_t>& words) {
  for (const std::uint16_t word : words) registers[address++] = word;
}

/// What the device answers to a request frame; functions 3 and 4 alike.
inline Bytes answer_of(const Registers& registers, const Bytes& request) {
  const auto word = [&](std::size_t at) { return request[at] << 8 | request[at + 1]; };
  const auto byte = [](int value) { return static_cast<std::uint8_t>(value & 0xFF); };
  const auto framed = [&](Bytes pdu) {
    const auto length = static_cast<int>(pdu.size()) + 1;
    Bytes frame{request[0], request[1], 0, 0, byte(length >> 8), byte(length), request[6]};
    frame.insert(frame.end(), pdu.begin(), pdu.end());
    return frame;
  };
  const std::uint8_t function = request[7];
  if (function != 3 && function != 4) return framed({byte(function | 0x80), 1});
  Bytes pdu{function, byte(2 * word(10))};
  for (int address = word(8); address < word(8) + word(10); ++address) {
    const auto found = registers.find(address);
    if (found == registers.end()) return framed({byte(function | 0x80), 2});
    pdu.push_back(byte(found->second >> 8));
    pdu.push_back(byte(found->second));
  }
  return framed(std::move(pdu));
}

/// @param registers  Outlives the server; may be changed between two reads.
inline Script register_device(const Registers& registers) {
  return [&registers](const Bytes& request, int) {
    return std::vector<Piece>{{{}, answer_of(registers, request)}};
  };
}

}  // namespace recald::testing
