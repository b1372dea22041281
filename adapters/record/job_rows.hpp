/// Rows of the record's `job` table.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "adapters/ports/store.hpp"
#include "adapters/postgres/connection.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::record {

/// What decides a job's result.
struct JobInput {
  std::string site;
  std::string version_sha256;  ///< Of the site's description.
  JobKind kind = JobKind::calibration;
  metering::Month month;
  std::int64_t until_seq = 0;
  metering::Instant now;

  [[nodiscard]] std::string sha256() const;
};

struct NewJob {
  JobInput input;
  std::int64_t site = 0;  ///< Its number in the record.
  int version = 0;
  std::string asked_by;
};

enum class IfThere : std::uint8_t { leave, run_again };

/// Inserts jobs and notifies the workers; of a job with the same input there is one. One that waits
/// or runs stays as it is.
/// @return how many were inserted or wait again
[[nodiscard]] Result<int> put_jobs(postgres::Connection& connection,
                                   const std::vector<NewJob>& jobs, IfThere if_there);

}  // namespace recald::record
