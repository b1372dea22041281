/// One meter on an endpoint: its registers and its load.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "simulators/devices/device_registers.hpp"
#include "simulators/devices/fault_script.hpp"
#include "simulators/devices/load_shape.hpp"

namespace recald::simulators {

struct SimulatedDevice {
  std::uint8_t unit = 1;
  const DeviceLayout* layout = nullptr;
  std::shared_ptr<const LoadShape> load;  ///< Shared by devices that use the same recording.
  double start_kWh = 0.0;                 ///< The counter at the start of the simulation.
};

/// The readout at `t`: the start value plus the load's energy since then, or since a reset.
///
/// @param begin   Start of the simulation.
/// @param faults  The active ones, in order of the script; the last of a kind counts.
[[nodiscard]] MeterReadout readout_of(const SimulatedDevice& device, SimulatedTime begin,
                                      SimulatedTime t, std::span<const ScriptedFault> faults);

}  // namespace recald::simulators
