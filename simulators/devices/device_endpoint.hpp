/// The devices behind one TCP endpoint or serial line, and what they answer: a function of the
/// request, the time and the script, without sockets.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "simulators/devices/device_frames.hpp"
#include "simulators/devices/simulated_device.hpp"

namespace recald::simulators {

/// Bytes that leave after a wait of real time, which counts from the piece before.
struct ReplyPiece {
  std::chrono::milliseconds wait{0};
  Bytes bytes;
};

class DeviceEndpoint {
 public:
  /// @param begin  Of the simulation; the script's times count from it.
  DeviceEndpoint(Transport transport, std::vector<SimulatedDevice> devices, FaultScript faults,
                 SimulatedTime begin);

  /// What comes back; nothing where the request stays without an answer.
  ///
  /// Only reads of a device's own function are carried out. Another function is answered with
  /// exception 1, registers outside the layout with 2, a count outside 1…125 with 3; a unit that
  /// is not there with 11 on TCP, as a gateway would, and not at all on a line.
  [[nodiscard]] std::vector<ReplyPiece> answer(const DeviceRequest& request, SimulatedTime t);

  /// Whether the endpoint itself is away.
  [[nodiscard]] bool refuses(SimulatedTime t) const;
  /// When that changes next after `t`.
  [[nodiscard]] std::optional<SimulatedTime> next_refusal_change(SimulatedTime t) const;

  [[nodiscard]] Transport transport() const { return transport_; }
  [[nodiscard]] const std::vector<SimulatedDevice>& devices() const { return devices_; }
  [[nodiscard]] long requests() const { return requests_; }
  /// Requests that would have changed a register: recald sends none.
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
