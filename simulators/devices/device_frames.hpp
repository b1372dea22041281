/// Modbus frames as a device sees them: finds requests in received bytes and frames the replies.
/// Written independently of the daemon's frames, so that a mistake is not repeated on both sides.
///
/// libmodbus is not used as the server: it selects on descriptors below 1024, carries out writes,
/// blocks its thread for half a second at an unknown function, and cannot reply late or wrongly,
/// which is the purpose of these devices.
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
  Bytes pdu;  ///< Function and its data, one byte or more.
};

struct TakenRequests {
  std::vector<DeviceRequest> requests;
  bool is_garbled = false;  ///< The last bytes are not Modbus, and their end cannot be determined.
};

/// Removes complete requests from the front of `received`; an incomplete one stays. Garbled bytes
/// are removed too: another protocol or an impossible length on TCP, a wrong checksum on RTU.
[[nodiscard]] TakenRequests take_requests(Transport transport, Bytes& received);

/// The frame of a reply: header or checksum, unit, PDU.
[[nodiscard]] Bytes reply_frame(Transport transport, const DeviceRequest& request,
                                std::uint8_t unit, const Bytes& pdu);

/// Position of function and byte count in a frame.
[[nodiscard]] constexpr std::size_t pdu_begin(Transport transport) {
  return transport == Transport::tcp ? 7 : 1;
}

}  // namespace recald::simulators
