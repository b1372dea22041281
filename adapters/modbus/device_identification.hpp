/// How a device identifies itself: function 0x2B with MEI type 0x0E, read device identification.
///
/// Plain functions on bytes, as in frame.hpp. They only read.
///
/// @see Modbus Application Protocol V1.1b3, section 6.21.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "adapters/modbus/frame.hpp"

namespace recald::modbus {

struct DeviceIdentity {
  std::string vendor;
  std::string product;
  std::string revision;

  bool operator==(const DeviceIdentity&) const = default;
};

using IdentityResult = tl::expected<DeviceIdentity, ReadFailure>;

/// Part of an identification: a device sends as many objects as fit into a frame.
struct IdentityPart {
  std::map<std::uint8_t, std::string> objects;  ///< 0 vendor, 1 product, 2 revision; as sent.
  std::uint8_t next_object = 0;                 ///< Where to continue; 0: this was the last part.
};

/// Unit and PDU of a request for the basic objects, starting with `first_object`.
[[nodiscard]] std::array<std::uint8_t, 5> encode_identity_request(std::uint8_t unit,
                                                                  std::uint8_t first_object);

/// Parses the PDU of a reply.
/// @return the part; mismatch if the reply contradicts itself, exception if the unit refuses.
[[nodiscard]] tl::expected<IdentityPart, ReadFailure> parse_identity_reply(
    std::span<const std::uint8_t> pdu);

}  // namespace recald::modbus
