/// /metrics, for Prometheus.
#pragma once

#include "daemon/gateway/serve/served.hpp"

namespace recald::daemon {

/// Everything that the gateway counts, and the calibration in use. README.md says what each says.
/// Labels come from the site file and from lists of our own, never from a device or a client. What
/// a meter never did has no series, so one in order has six of them.
[[nodiscard]] http::Response metrics(const Served& served);

}  // namespace recald::daemon
