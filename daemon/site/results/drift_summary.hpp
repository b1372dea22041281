/// What the months after a calibration say of it, as its job and drift.json tell it.
#pragma once

#include "adapters/ports/job_result.hpp"
#include "daemon/site/drift/site_drift.hpp"

namespace recald::daemon {

/// Indices become names, causes words.
[[nodiscard]] DriftSummary summary_of(const SiteDrift& drift);

}  // namespace recald::daemon
