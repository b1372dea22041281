#include "adapters/modbus/device_identification.hpp"

#include <fmt/format.h>

namespace recald::modbus {
namespace {

constexpr std::uint8_t kFunction = 0x2B;
constexpr std::uint8_t kMeiType = 0x0E;
constexpr std::uint8_t kBasic = 0x01;  // vendor, product, revision, as a stream
constexpr std::uint8_t kMoreFollows = 0xFF;
constexpr std::size_t kFixed = 7;  // function, type, code, conformity, more, next, number

}  // namespace

std::array<std::uint8_t, 5> encode_identity_request(std::uint8_t unit, std::uint8_t first_object) {
  return {unit, kFunction, kMeiType, kBasic, first_object};
}

tl::expected<IdentityPart, ReadFailure> parse_identity_reply(std::span<const std::uint8_t> pdu) {
  if (pdu.size() == 2 && pdu[0] == (kFunction | 0x80)) {
    return tl::unexpected(
        ReadFailure{ReadFault::exception, pdu[1],
                    fmt::format("the unit answers exception {}", describe_exception(pdu[1]))});
  }
  if (pdu.size() < kFixed || pdu[0] != kFunction || pdu[1] != kMeiType) {
    return mismatch("the reply is no device identification");
  }
  IdentityPart part;
  if (pdu[4] == kMoreFollows) part.next_object = pdu[5];
  auto rest = pdu.subspan(kFixed);
  for (int i = 0; i < pdu[6]; ++i) {
    if (rest.size() < 2 || rest.size() < 2u + rest[1]) {
      return mismatch(
          fmt::format("the identification ends within its object {} of {}", i + 1, pdu[6]));
    }
    const auto text = rest.subspan(2, rest[1]);
    part.objects[rest[0]] = std::string{text.begin(), text.end()};
    rest = rest.subspan(2u + rest[1]);
  }
  if (!rest.empty()) {
    return mismatch(fmt::format("{} bytes follow the identification", rest.size()));
  }
  return part;
}

}  // namespace recald::modbus
