/// The simulated devices and their addresses, from a TOML file.
///
///     [[endpoint]]
///     type = "tcp"               # or "rtu"
///     port = 1502                # on 127.0.0.1; 0 or absent: the system chooses
///     single_connection = true   # default false; refuses a second client while the first lives
///     faults = "gateway.faults"  # default: the script of --faults
///
///     [[endpoint.device]]
///     unit = 1
///     layout = "abb-b23"
///     load_kW = 40               # or 24 numbers, the hours of a day in UTC
///     start_kWh = 1200           # default 0
///
///     [[endpoint]]
///     type = "rtu"
///     link = "/tmp/ttyMETERS"    # becomes a link to the pseudo-terminal
///     repeat = 8                 # /tmp/ttyMETERS0 to 7; for TCP, as many consecutive ports
///
///     [[endpoint.device]]
///     unit = 1
///     repeat = 4                 # units 1 to 4
///     layout = "eastron-sdm630"
///     recording = "readings.csv" # as recald-sim building writes it
///     meter = "electricity"
///
/// Each copy made by `repeat` starts 1 000 kWh above the one before, so that no two can be
/// confused. Paths are relative to the plan.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "simulators/devices/device_frames.hpp"
#include "simulators/devices/simulated_device.hpp"

namespace recald::simulators {

struct EndpointPlan {
  Transport transport = Transport::tcp;
  std::uint16_t port = 0;      ///< TCP.
  std::filesystem::path link;  ///< RTU.
  bool single_connection = false;
  FaultScript faults;
  std::vector<SimulatedDevice> devices;
};

/// @param faults  For endpoints without a script of their own.
/// @return the endpoints, at least one with at least one device each; or not_found, or the first
///         mistake with file and line.
[[nodiscard]] Result<std::vector<EndpointPlan>> read_device_plan(const std::filesystem::path& file,
                                                                 const FaultScript& faults);

/// Reads a script file. @return not_found, or malformed with every wrong line.
[[nodiscard]] Result<FaultScript> read_fault_script(const std::filesystem::path& file);

}  // namespace recald::simulators
