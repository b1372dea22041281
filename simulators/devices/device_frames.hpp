/// Modbus frames as a device sees them: requests found in the bytes that came, replies put into
/// frames. Written apart from the daemon's frames, so that a mistake meets no mirror image.
///
/// libmodbus is not the server here: it selects on descriptors below 1024, carries out writes,
/// holds its thread for half a second at an unknown function, and cannot be late or wrong, which
/// is what these devices are for.
///
/// @see Modbus Messaging on TCP/IP V1.0b, 3.1.3; Modbus over Serial Line V1.02, 2.5.1.
#pragma once

#include <cstdint>
#include <vector>

namespace recald::simulators {

using Bytes = std::vector<std::uint8_t>;

enum class Transport : std::uint8_t { tcp, rtu };

struct DeviceRequest {
  std::uint16_t transaction = 0;  ///< Zero on RTU, which has none.
  std::uint8_t unit = 0;
  Bytes pdu;  ///< Function and what follows, one byte or more.
};

struct TakenRequests {
  std::vector<DeviceRequest> requests;
  bool is_garbled = false;  ///< What came last is no Modbus; where it ends cannot be told.
};

/// Removes the whole requests from the front of `received`; an incomplete one stays. What is
/// garbled is removed, too: another protocol or an impossible length on TCP, a wrong check sum on
/// RTU.
[[nodiscard]] TakenRequests take_requests(Transport transport, Bytes& received);

/// The frame of a reply: header or check sum, unit, PDU.
[[nodiscard]] Bytes reply_frame(Transport transport, const DeviceRequest& request,
                                std::uint8_t unit, const Bytes& pdu);

/// Where function and byte count stand in a frame.
[[nodiscard]] constexpr std::size_t pdu_begin(Transport transport) {
  return transport == Transport::tcp ? 7 : 1;
}

}  // namespace recald::simulators
