/// Whether the daemon can do its job: stamp and store readings.
#pragma once

#include <string>
#include <vector>

#include "daemon/gateway/serve/served.hpp"

namespace recald::daemon {

/// Why not, in sentences; empty when ready. A meter that is silent is no reason: the others are
/// served, and restarting the daemon would not wake it.
[[nodiscard]] std::vector<std::string> reasons_not_ready(const GatewayStatus& status);

/// What should be looked at although the daemon is ready, in sentences: registers that a device
/// refuses, or is too busy for, devices that their gateway does not reach, and weather sensors that
/// are silent or stand still.
[[nodiscard]] std::vector<std::string> reasons_to_look(const GatewayStatus& status);

/// /healthz: 200 as long as the loop turns.
[[nodiscard]] http::Response health();

/// /readyz: 200, or 503 with the reasons; with what deserves a look in both cases.
[[nodiscard]] http::Response readiness(const Served& served);

}  // namespace recald::daemon
