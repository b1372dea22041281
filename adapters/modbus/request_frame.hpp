/// Modbus TCP requests as a server takes them, cut out of the bytes of a connection.
///
/// Plain functions on bytes, so that they can be fuzzed. libmodbus would carry writes out, wait for
/// the rest of half a frame, and believe a false length, so it sees only what has passed here.
///
/// @see Modbus Messaging on TCP/IP Implementation Guide V1.0b, 3.1.3; Modbus Application Protocol
///      V1.1b3, section 6.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace recald::modbus {

inline constexpr std::size_t kTcpFrameMax = 260;  ///< Header of 7 bytes and a PDU of at most 253.

/// What the bytes received so far begin with.
struct CutRequest {
  enum class Kind : std::uint8_t {
    incomplete,  ///< More bytes are needed.
    malformed,   ///< No Modbus TCP; where the next frame begins cannot be known.
    whole,
  };
  Kind kind;
  std::size_t size = 0;  ///< Of a whole frame, in bytes; at most `kTcpFrameMax`.
};

/// Takes the first frame, and says malformed as soon as the bytes are enough to know.
[[nodiscard]] CutRequest cut_request(std::span<const std::uint8_t> bytes);

/// How a whole frame is to be answered.
enum class RequestVerdict : std::uint8_t {
  read = 0,              ///< Function 3 or 4, all of it on the map.
  illegal_function = 1,  ///< Anything else, writes above all.
  illegal_address = 2,   ///< Reaches beyond the map.
  illegal_value = 3,     ///< A count outside 1…125, or a length that is not the function's.
};

/// @param frame      As cut.
/// @param registers  Of the map, which begins at address 0.
[[nodiscard]] RequestVerdict check_request(std::span<const std::uint8_t> frame,
                                           std::size_t registers);

}  // namespace recald::modbus
