/// Runs calibrations and diagnoses beside polling: takes requests, runs one job at a
/// time, stores results.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapters/ports/alive.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/store.hpp"
#include "adapters/ports/worker.hpp"
#include "daemon/gateway/run/job_watch.hpp"
#include "daemon/gateway/serve/api/served.hpp"

namespace recald::daemon {

struct JobOutcome {
  bool accepted = false;  ///< Its checks pass: this result is in use from now on.
  bool named = false;     ///< A diagnosis named something.
  bool failed = false;    ///< It failed: `message` says why, `result` what it lacked.
  std::string message;    ///< Which check failed, or what was missing; else empty.
  std::string folder;     ///< Contains its files.
  JobResult result;
  std::vector<StoredForecast> forecasts;  ///< To be stored.
  std::optional<JobKind> next;            ///< A job that this one calls for …
  std::string next_asked_by = "drift";    ///< … and as whose request.
};

/// Runs a job on the worker. @param now  When it began.
/// @return the outcome; cancelled when a stop was requested; or why it failed.
using DoJob =
    std::function<Result<JobOutcome>(const StoredJob& job, metering::Instant now, JobWatch& watch)>;

/// Called after every stored change of a job's state.
using OnJob = std::function<void(const StoredJob&)>;

/// Called with each event that was stored together with a job.
using OnJobEvent = std::function<void(const StoreEvent&)>;

/// A job is stored before its number is reported, and its outcome before the next one begins, so a
/// kill at any moment loses no request. The running job runs again in the next process, three
/// times at most, because a job that gets the process killed, perhaps for its memory, would
/// otherwise do so forever.
class JobRunner {
 public:
  struct Ports {
    Loop& loop;
    Store& store;
    Worker& worker;
  };
  JobRunner(Ports ports, DoJob work, OnJob on_job, OnJobEvent on_event = {});
  ~JobRunner();
  JobRunner(const JobRunner&) = delete;
  JobRunner& operator=(const JobRunner&) = delete;

  /// Applies to jobs that start from now on; a running job is not affected.
  void set_work(DoJob work) { work_ = std::move(work); }

  /// Resumes the requests of an earlier process; waits while the store refuses.
  void resume();

  /// Requests a job. If one is already waiting, it serves the request, since it will use
  /// the same readings.
  /// @return the job's number, or the store's failure.
  [[nodiscard]] Result<std::int64_t> ask(JobKind kind, const std::string& asked_by);

  /// Cancels a job; a running one ends as soon as it can.
  /// @return not_found when no such job waits or runs.
  [[nodiscard]] Result<void> cancel(std::int64_t number);

  [[nodiscard]] bool is_running() const { return stage_ == Stage::running; }

  /// How far the running job is; nothing if none runs, or it has not said yet.
  [[nodiscard]] std::optional<JobProgress> progress() const;

  /// Call when the process ends: a running job is interrupted, and runs again in the next process.
  void interrupt();

 private:
  enum class Stage { idle, running, keeping };

  [[nodiscard]] Result<void> take_up_unfinished();
  [[nodiscard]] Result<void> end(StoredJob job, JobState state);
  [[nodiscard]] Result<void> put_with_events(const StoredJob& job, bool has_named);
  void begin_next();
  void finish(Result<JobOutcome> outcome);
  void keep();
  void try_later(void (JobRunner::*step)());

  Ports ports_;
  DoJob work_;
  OnJob on_job_;
  OnJobEvent on_event_;
  Stage stage_ = Stage::idle;
  StoredJob current_;                      ///< Valid unless idle.
  bool has_named_ = false;                 ///< Of `current_`, as the next.
  std::vector<StoredForecast> forecasts_;  ///< To be stored.
  std::optional<JobKind> next_;            ///< To be requested before `current_` is stored.
  std::string next_asked_by_;
  bool cancelled_ = false;  ///< `current_` was cancelled.
  std::shared_ptr<JobWatch> watch_;
  Alive alive_;
};

}  // namespace recald::daemon
