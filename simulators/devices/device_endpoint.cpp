#include "simulators/devices/device_endpoint.hpp"

#include <algorithm>
#include <array>

namespace recald::simulators {
namespace {

using std::chrono::milliseconds;

constexpr std::uint8_t kExceptionBit = 0x80;
constexpr int kRegistersMax = 125;

enum class ExceptionCode : std::uint8_t {
  illegal_function = 1,
  illegal_address = 2,
  illegal_value = 3,
  no_reply_of_target = 11,
};

/// Single and multiple coils and registers, mask write, read and write.
bool is_write(std::uint8_t function) {
  constexpr std::array<std::uint8_t, 6> kWrites{5, 6, 15, 16, 22, 23};
  return std::ranges::find(kWrites, function) != kWrites.end();
}

Bytes exception_pdu(std::uint8_t function, std::uint8_t code) {
  return {static_cast<std::uint8_t>(function | kExceptionBit), code};
}

Bytes exception_pdu(std::uint8_t function, ExceptionCode code) {
  return exception_pdu(function, static_cast<std::uint8_t>(code));
}

std::uint8_t byte_of(double amount) { return static_cast<std::uint8_t>(static_cast<int>(amount)); }

/// Applies faults before the frame is closed, so that its checksum is right.
void falsify_pdu(std::span<const ScriptedFault> faults, std::uint8_t& unit, Bytes& pdu) {
  for (const ScriptedFault& fault : faults) {
    if (fault.kind == DeviceFaultKind::wrong_unit) unit = byte_of(fault.amount);
    if (fault.kind == DeviceFaultKind::wrong_count && (pdu[0] & kExceptionBit) == 0) {
      pdu[1] = byte_of(fault.amount);
    }
    if (fault.kind == DeviceFaultKind::exception) {
      pdu = exception_pdu(pdu[0] & ~kExceptionBit & 0xFF, byte_of(fault.amount));
    }
  }
}

void falsify_frame(std::span<const ScriptedFault> faults, Transport transport, Bytes& frame) {
  for (const ScriptedFault& fault : faults) {
    if (fault.kind == DeviceFaultKind::wrong_length && transport == Transport::tcp) {
      frame[4] = byte_of(fault.amount / 256.0);
      frame[5] = byte_of(fault.amount);
    }
    if (fault.kind != DeviceFaultKind::flip) continue;
    const auto bit = static_cast<std::size_t>(fault.amount);
    if (bit / 8 < frame.size()) frame[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
}

/// One piece, or three: up to the byte count, half of the data, the rest.
std::vector<ReplyPiece> in_pieces(std::span<const ScriptedFault> faults, Transport transport,
                                  const Bytes& frame) {
  milliseconds late{0};
  std::optional<milliseconds> pause;
  for (const ScriptedFault& fault : faults) {
    const milliseconds amount{static_cast<std::int64_t>(fault.amount)};
    if (fault.kind == DeviceFaultKind::late) late += amount;
    if (fault.kind == DeviceFaultKind::split) pause = amount;
  }
  if (!pause) return {{late, frame}};
  const auto header = static_cast<std::ptrdiff_t>(pdu_begin(transport));
  const auto middle = header + (static_cast<std::ptrdiff_t>(frame.size()) - header + 1) / 2;
  return {{late, Bytes(frame.begin(), frame.begin() + header)},
          {*pause, Bytes(frame.begin() + header, frame.begin() + middle)},
          {*pause, Bytes(frame.begin() + middle, frame.end())}};
}

}  // namespace

DeviceEndpoint::DeviceEndpoint(Transport transport, std::vector<SimulatedDevice> devices,
                               FaultScript faults, SimulatedTime begin)
    : transport_(transport),
      devices_(std::move(devices)),
      faults_(std::move(faults)),
      begin_(begin) {}

std::optional<Bytes> DeviceEndpoint::honest_pdu(const DeviceRequest& request, SimulatedTime t,
                                                std::span<const ScriptedFault> faults) const {
  const std::uint8_t function = request.pdu[0];
  const auto device = std::ranges::find(devices_, request.unit, &SimulatedDevice::unit);
  if (device == devices_.end()) {
    if (transport_ == Transport::rtu) return {};
    return exception_pdu(function, ExceptionCode::no_reply_of_target);
  }
  if (function != device->layout->function) {
    return exception_pdu(function, ExceptionCode::illegal_function);
  }
  if (request.pdu.size() != 5) return exception_pdu(function, ExceptionCode::illegal_value);
  const int address = request.pdu[1] << 8 | request.pdu[2];
  const int count = request.pdu[3] << 8 | request.pdu[4];
  if (count < 1 || count > kRegistersMax) {
    return exception_pdu(function, ExceptionCode::illegal_value);
  }
  const auto registers =
      registers_of(*device->layout, readout_of(*device, begin_, t, faults), address, count);
  if (!registers) return exception_pdu(function, ExceptionCode::illegal_address);
  Bytes pdu{function, static_cast<std::uint8_t>(2 * count)};
  for (const std::uint16_t word : *registers) {
    pdu.push_back(static_cast<std::uint8_t>(word >> 8));
    pdu.push_back(static_cast<std::uint8_t>(word & 0xFF));
  }
  return pdu;
}

std::vector<ReplyPiece> DeviceEndpoint::answer(const DeviceRequest& request, SimulatedTime t) {
  ++requests_;
  if (is_write(request.pdu[0])) ++writes_;
  const auto faults =
      faults_.at(std::chrono::duration_cast<milliseconds>(t - begin_), request.unit);
  const bool says_nothing = std::ranges::any_of(faults, [](const ScriptedFault& fault) {
    return fault.kind == DeviceFaultKind::silent || fault.kind == DeviceFaultKind::refuse;
  });
  if (says_nothing) return {};
  auto pdu = honest_pdu(request, t, faults);
  if (!pdu) return {};
  std::uint8_t unit = request.unit;
  falsify_pdu(faults, unit, *pdu);
  Bytes frame = reply_frame(transport_, request, unit, *pdu);
  falsify_frame(faults, transport_, frame);
  return in_pieces(faults, transport_, frame);
}

bool DeviceEndpoint::refuses(SimulatedTime t) const {
  return std::ranges::any_of(faults_.faults, [&](const ScriptedFault& fault) {
    return fault.kind == DeviceFaultKind::refuse && t >= begin_ + fault.begin &&
           t < begin_ + fault.end;
  });
}

std::optional<SimulatedTime> DeviceEndpoint::next_refusal_change(SimulatedTime t) const {
  std::optional<SimulatedTime> next;
  for (const ScriptedFault& fault : faults_.faults) {
    if (fault.kind != DeviceFaultKind::refuse) continue;
    for (const SimulatedTime change : {begin_ + fault.begin, begin_ + fault.end}) {
      if (change > t && (!next || change < *next)) next = change;
    }
  }
  return next;
}

}  // namespace recald::simulators
