/// A job of a fleet for programs: the API and the command line say the same.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "adapters/record/jobs.hpp"

namespace recald::daemon {

[[nodiscard]] nlohmann::ordered_json fleet_job_json(const record::FleetJob& job);

}  // namespace recald::daemon
