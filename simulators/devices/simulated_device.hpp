/// One meter on an endpoint: which registers it has and what it counts.
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
  std::shared_ptr<const LoadShape> load;  ///< Shared by those that read the same recording.
  double start_kWh = 0.0;                 ///< The counter when the simulation begins.
};

/// What the device shows at `t`: its start and what the load drew since, or since it was reset.
///
/// @param begin   Of the simulation.
/// @param faults  Those in force then, in order of the script; the last of a kind counts.
[[nodiscard]] MeterReadout readout_of(const SimulatedDevice& device, SimulatedTime begin,
                                      SimulatedTime t, std::span<const ScriptedFault> faults);

}  // namespace recald::simulators
