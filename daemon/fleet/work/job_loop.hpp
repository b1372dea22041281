/// Does the jobs of a fleet, one after the other, each in a process of its own.
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>

#include "adapters/record/jobs.hpp"
#include "daemon/fleet/config/fleet_config.hpp"
#include "daemon/fleet/config/keep_trying.hpp"

namespace recald::daemon {

struct JobLoop {
  RecordConfig record;
  WorkerConfig worker;
  std::string name;               ///< Of the worker, for people: "host/1234/1".
  std::filesystem::path program;  ///< recald itself.
  record::LeaseRules rules = {};
  std::chrono::milliseconds poll_every{30'000};  ///< Unless the record calls earlier.
  bool ends_when_idle = false;                   ///< Otherwise it waits for the next job.
};

/// Takes jobs until it is told to stop. A job that kills its process, or runs out of memory or
/// time, is given back, and set aside after some tries; other jobs go on. What is interrupted is
/// handed back at once. While the record is away it tries again, 5 s to 60 s apart.
/// @param report  Gets a sentence about each job and each change. Called on this thread.
/// @return how many jobs were done or failed.
[[nodiscard]] int do_jobs(const JobLoop& loop, const Report& report, const std::stop_token& stop);

}  // namespace recald::daemon
