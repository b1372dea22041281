/// Calibrations and diagnoses beside polling: requested, run one at a time, stored with their
/// results.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapters/ports/loop.hpp"
#include "adapters/ports/store.hpp"
#include "adapters/ports/worker.hpp"

namespace recald::daemon {

struct JobOutcome {
  bool accepted = false;  ///< Its gates hold: this is the result in use from now on.
  bool failed = false;    ///< It could not be done: `message` says why, `result` what it lacked.
  std::string message;    ///< Which gate failed, or what it was made without; else empty.
  std::string folder;     ///< With its files.
  JobResult result;
  std::vector<StoredForecast> forecasts;  ///< For the record.
  std::optional<JobKind> next;            ///< What it gives reason for; "drift" asks for it.
};

/// False as soon as the job is to end early. Safe from any thread.
using GoesOn = std::function<bool()>;

/// Does a job, on the worker. @param now  When it began.
/// @return what came of it; cancelled when it was told not to go on; or why it failed.
using DoJob = std::function<Result<JobOutcome>(const StoredJob& job, metering::Instant now,
                                               const GoesOn& goes_on)>;

/// Told of every change of a job's state that has been stored.
using OnJob = std::function<void(const StoredJob&)>;

/// A job is stored before its number is reported, and its outcome before the next one begins, so a
/// kill at any moment loses no request. The job that was running runs again, three times at most,
/// because a job that gets the process killed, perhaps for its memory, would otherwise do so for
/// ever.
class JobRunner {
 public:
  struct Ports {
    Loop& loop;
    Store& store;
    Worker& worker;
  };
  JobRunner(Ports ports, DoJob work, OnJob on_job);
  ~JobRunner();
  JobRunner(const JobRunner&) = delete;
  JobRunner& operator=(const JobRunner&) = delete;

  /// Applies to jobs that begin from now on; a running job continues unchanged.
  void set_work(DoJob work) { work_ = std::move(work); }

  /// Takes up what an earlier process was asked for; later, while the store refuses.
  void resume();

  /// A job that is already waiting serves the request: it will use the same readings.
  /// @return the job's number, or the store's failure.
  [[nodiscard]] Result<std::int64_t> ask(JobKind kind, const std::string& asked_by);

  /// A job that runs ends as soon as it can.
  /// @return not_found when no such job waits or runs.
  [[nodiscard]] Result<void> cancel(std::int64_t number);

  /// Called when the process ends: a running job is interrupted, and runs again in the next
  /// process.
  void interrupt();

 private:
  enum class Stage { idle, running, keeping };

  [[nodiscard]] Result<void> take_up_unfinished();
  [[nodiscard]] Result<void> end(StoredJob job, JobState state);
  void begin_next();
  void finish(Result<JobOutcome> outcome);
  void keep();
  void try_later(void (JobRunner::*step)());

  Ports ports_;
  DoJob work_;
  OnJob on_job_;
  Stage stage_ = Stage::idle;
  StoredJob current_;                      ///< Unless idle.
  std::vector<StoredForecast> forecasts_;  ///< Of `current_`, to be kept.
  std::optional<JobKind> next_;            ///< To be asked for before `current_` is kept.
  bool cancelled_ = false;                 ///< `current_` was cancelled.
  std::shared_ptr<std::atomic<bool>> running_goes_on_;
  std::shared_ptr<JobRunner*> self_;
};

}  // namespace recald::daemon
