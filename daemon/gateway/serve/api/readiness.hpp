/// Whether the daemon can do its job: stamp and store readings.
#pragma once

#include <string>
#include <vector>

#include "daemon/gateway/serve/api/served.hpp"

namespace recald::daemon {

/// Why not, in sentences; empty when ready. A silent meter is not a reason: the others are served,
/// and restarting the daemon would not wake it.
[[nodiscard]] std::vector<std::string> reasons_not_ready(const GatewayStatus& status);

/// Other things to check although the daemon is ready, in sentences: registers that a device
/// refuses or is too busy to serve, devices that their gateway cannot reach, and weather sensors
/// that are silent or frozen.
[[nodiscard]] std::vector<std::string> reasons_to_look(const GatewayStatus& status);

/// /healthz: 200 as long as the loop runs.
[[nodiscard]] http::Response health();

/// /readyz: 200, or 503 with the reasons; in both cases with other things to check.
[[nodiscard]] http::Response readiness(const Served& served);

}  // namespace recald::daemon
