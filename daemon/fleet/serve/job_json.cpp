#include "daemon/fleet/serve/job_json.hpp"

#include <nlohmann/json.hpp>

namespace recald::daemon {

nlohmann::ordered_json fleet_job_json(const record::FleetJob& job) {
  return {{"number", job.number},
          {"site", job.site},
          {"kind", name_of(job.kind)},
          {"month", metering::to_string(job.month)},
          {"state", name_of(job.state)},
          {"tries", job.tries},
          {"worker", job.worker},
          {"reason", job.reason},
          {"input_sha256", job.input_sha256}};
}

}  // namespace recald::daemon
