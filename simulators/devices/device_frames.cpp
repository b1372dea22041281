#include "simulators/devices/device_frames.hpp"

#include <optional>
#include <span>

namespace recald::simulators {
namespace {

constexpr std::size_t kHeader = 6;  ///< Transaction, protocol and length, before the unit.
constexpr std::size_t kLengthMax = 254;

std::uint16_t big_endian(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

/// Bit by bit as in the specification; the daemon uses a table.
std::uint16_t check_sum(std::span<const std::uint8_t> bytes) {
  unsigned sum = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    sum ^= byte;
    for (int bit = 0; bit < 8; ++bit) sum = (sum & 1) != 0 ? sum >> 1 ^ 0xA001 : sum >> 1;
  }
  return static_cast<std::uint16_t>(sum);
}

/// Length of an RTU request without its checksum, which follows from its function; nothing if there
/// are too few bytes yet. Unknown functions are assumed to end where the bytes do.
std::optional<std::size_t> rtu_body_size(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 4) return {};
  const auto with_bytes = [&](std::size_t count_at) -> std::optional<std::size_t> {
    if (bytes.size() <= count_at) return {};
    return count_at + 1 + bytes[count_at];
  };
  switch (bytes[1]) {
    case 1:
    case 2:
    case 3:
    case 4:
    case 5:
    case 6:
      return 6;
    case 15:
    case 16:
      return with_bytes(6);
    case 22:
      return 8;
    case 23:
      return with_bytes(10);
    default:
      return bytes.size() - 2;
  }
}

void drop_front(Bytes& bytes, std::size_t count) {
  bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
}

TakenRequests take_tcp(Bytes& received) {
  TakenRequests taken;
  while (received.size() > kHeader) {
    const std::size_t length = big_endian(received, 4);
    if (big_endian(received, 2) != 0 || length < 2 || length > kLengthMax) {
      received.clear();
      taken.is_garbled = true;
      break;
    }
    if (received.size() < kHeader + length) break;
    const auto pdu = received.begin() + kHeader + 1;
    taken.requests.push_back({big_endian(received, 0), received[kHeader],
                              Bytes(pdu, pdu + static_cast<std::ptrdiff_t>(length - 1))});
    drop_front(received, kHeader + length);
  }
  return taken;
}

TakenRequests take_rtu(Bytes& received) {
  TakenRequests taken;
  while (const auto body = rtu_body_size(received)) {
    if (received.size() < *body + 2) break;
    const unsigned sum = received[*body] | received[*body + 1] << 8;
    if (sum != check_sum(std::span{received}.first(*body))) {
      received.clear();
      taken.is_garbled = true;
      break;
    }
    const auto end = received.begin() + static_cast<std::ptrdiff_t>(*body);
    taken.requests.push_back({0, received[0], Bytes(received.begin() + 1, end)});
    drop_front(received, *body + 2);
  }
  return taken;
}

}  // namespace

TakenRequests take_requests(Transport transport, Bytes& received) {
  return transport == Transport::tcp ? take_tcp(received) : take_rtu(received);
}

Bytes reply_frame(Transport transport, const DeviceRequest& request, std::uint8_t unit,
                  const Bytes& pdu) {
  const auto low = [](std::size_t value) { return static_cast<std::uint8_t>(value & 0xFF); };
  Bytes frame;
  if (transport == Transport::tcp) {
    const std::size_t length = pdu.size() + 1;
    frame = {low(request.transaction >> 8),
             low(request.transaction),
             0,
             0,
             low(length >> 8),
             low(length)};
  }
  frame.push_back(unit);
  frame.insert(frame.end(), pdu.begin(), pdu.end());
  if (transport == Transport::rtu) {
    const std::uint16_t sum = check_sum(frame);
    frame.push_back(low(sum));
    frame.push_back(low(sum >> 8));
  }
  return frame;
}

}  // namespace recald::simulators
