/// What the months after a calibration say of it, as its job and drift.json tell it.
#pragma once

#include "adapters/ports/job_result.hpp"
#include "core/drift/site_drift.hpp"

namespace recald::views {

/// Indices become names, causes words.
[[nodiscard]] DriftSummary summary_of(const drift::SiteDrift& drift);

}  // namespace recald::views
