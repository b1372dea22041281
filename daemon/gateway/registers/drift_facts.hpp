/// What the calibration in use and the newest diagnosis say, for registers.
#pragma once

#include <string>

#include "adapters/ports/job_result.hpp"
#include "daemon/gateway/registers/register_facts.hpp"

namespace recald::daemon {

/// Of one meter's outputs. An alarm is open while the newest month that was followed is the one
/// that raised it, or while nothing has come of it yet.
[[nodiscard]] DriftFacts drift_of(const DriftSummary& drift, const std::string& meter);

/// @param document  diagnosis.json. @return none where nothing was named, or it cannot be read.
[[nodiscard]] AlarmCode named_in(const std::string& document);

}  // namespace recald::daemon
