/// Calibrations and diagnoses: those that wait, run, and their results.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/ports/job_result.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald {

enum class JobKind : std::uint8_t { calibration, diagnosis };
enum class JobState : std::uint8_t { waiting, running, done, failed, cancelled };

/// Of a job's message, in bytes: what is longer is shortened when it is stored.
inline constexpr std::size_t kJobMessageMax = 16'000;

/// A long task and, once it is done, its result.
struct StoredJob {
  std::int64_t number = 0;  ///< Set by the store; 1, 2, 3 …
  JobKind kind = JobKind::calibration;
  JobState state = JobState::waiting;
  std::string asked_by;  ///< "month", "weather", "schedule", "api", "signal", "drift"
  metering::Instant asked;
  std::optional<metering::Instant> started;
  std::optional<metering::Instant> ended;
  bool accepted = false;  ///< Passed its checks; the latest such result is in use.
  std::string message;    ///< Why it failed or was not accepted; else empty.
  std::string folder;     ///< Holds its files, beside the store; empty: none.
  int tries = 0;          ///< Number of times it was started.
  JobResult result;       ///< Empty until done.
};

/// "calibration", "running" and so on, as in files and for people.
[[nodiscard]] std::string_view name_of(JobKind kind);
[[nodiscard]] std::string_view name_of(JobState state);

class JobStore {
 public:
  virtual ~JobStore() = default;

  /// Adds a job and ignores its number. @return the new number.
  virtual Result<std::int64_t> add_job(const StoredJob& job) = 0;

  /// Updates a job. @return not_found for an unknown number.
  virtual Result<void> put_job(const StoredJob& job) = 0;

  virtual Result<std::optional<StoredJob>> job(std::int64_t number) = 0;

  /// Newest first, without their results.
  virtual Result<std::vector<StoredJob>> jobs(JobKind kind, int limit) = 0;

  /// The oldest finished job that is neither among the newest `kept` finished ones nor in use (the
  /// newest accepted one). Without its result.
  virtual Result<std::optional<StoredJob>> oldest_job_beyond(JobKind kind, int kept) = 0;

  virtual Result<void> delete_job(std::int64_t number) = 0;

  /// The newest accepted job, with its result.
  virtual Result<std::optional<StoredJob>> last_accepted(JobKind kind) = 0;

  /// Waiting or running jobs, oldest first.
  virtual Result<std::vector<StoredJob>> unfinished_jobs() = 0;
};

}  // namespace recald
