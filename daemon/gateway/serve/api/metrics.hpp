/// /metrics, for Prometheus.
#pragma once

#include "daemon/gateway/serve/api/served.hpp"

namespace recald::daemon {

/// Everything that the gateway counts, and the calibration in use. README.md explains each metric.
/// Labels come from the site file and from fixed lists, never from a device or a client. Values
/// that never occurred have no series, so a healthy meter has six.
[[nodiscard]] http::Response metrics(const Served& served);

}  // namespace recald::daemon
