/// The devices behind one TCP endpoint or serial line, and their replies: a function of the
/// request, the time and the script, without sockets.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "simulators/devices/device_frames.hpp"
#include "simulators/devices/simulated_device.hpp"

namespace recald::simulators {

/// Bytes sent after a wait in real time, counted from the previous piece.
struct ReplyPiece {
  std::chrono::milliseconds wait{0};
  Bytes bytes;
};

class DeviceEndpoint {
 public:
  /// @param begin  Start of the simulation; the script's times count from it.
  DeviceEndpoint(Transport transport, std::vector<SimulatedDevice> devices, FaultScript faults,
                 SimulatedTime begin);

  /// The reply, or nothing if the request gets none.
  ///
  /// Only reads with a device's own function succeed. Another function gets exception 1, registers
  /// outside the layout 2, a count outside 1…125 gets 3; a missing unit gets 11 on TCP, as from a
  /// gateway, and no reply on a serial line.
  [[nodiscard]] std::vector<ReplyPiece> answer(const DeviceRequest& request, SimulatedTime t);

  /// Whether the endpoint itself is down.
  [[nodiscard]] bool refuses(SimulatedTime t) const;
  /// Time of the next change after `t`.
  [[nodiscard]] std::optional<SimulatedTime> next_refusal_change(SimulatedTime t) const;

  [[nodiscard]] Transport transport() const { return transport_; }
  [[nodiscard]] const std::vector<SimulatedDevice>& devices() const { return devices_; }
  [[nodiscard]] long requests() const { return requests_; }
  /// Requests to write a register: recald must send none.
  [[nodiscard]] long writes() const { return writes_; }

 private:
  [[nodiscard]] std::optional<Bytes> honest_pdu(const DeviceRequest& request, SimulatedTime t,
                                                std::span<const ScriptedFault> faults) const;

  Transport transport_;
  std::vector<SimulatedDevice> devices_;
  FaultScript faults_;
  SimulatedTime begin_;
  long requests_ = 0;
  long writes_ = 0;
};

}  // namespace recald::simulators
