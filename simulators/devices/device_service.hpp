/// Simulated devices as a process: opens all endpoints, serves them on one loop, ends at a signal.
#pragma once

#include <iosfwd>
#include <vector>

#include "core/metering/registers/trial_clock.hpp"
#include "core/result.hpp"
#include "simulators/devices/device_plan.hpp"

namespace recald::simulators {

struct DeviceTotals {
  long requests;
  long writes;
};

/// Serves until SIGTERM or SIGINT.
///
/// @param told  Receives one line per endpoint once all are listening, "listening on
///              127.0.0.1:1502: units 1 2", and then "ready: 3 endpoints, 8 devices".
/// @return the totals, or io_failed when an endpoint cannot be opened.
[[nodiscard]] Result<DeviceTotals> serve_devices(std::vector<EndpointPlan> plans,
                                                 const metering::TrialClock& clock,
                                                 std::ostream& told);

}  // namespace recald::simulators
