#include "daemon/gateway/run/job_runner.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <exception>
#include <new>
#include <set>
#include <utility>

#include "daemon/gateway/run/job_events.hpp"

namespace recald::daemon {
namespace {

constexpr std::chrono::seconds kTryAgain{10};
constexpr int kTriesMax = 3;

/// An exception of the work is the reason for its failure.
Result<JobOutcome> done_safely(const DoJob& work, const StoredJob& job, JobWatch& watch) {
  try {
    return work(job, *job.started, watch);
  } catch (const std::bad_alloc&) {
    return failure(ErrorCode::io_failed, "there is not enough memory for the job");
  } catch (const std::exception& thrown) {
    return failure(
        ErrorCode::unsupported,
        fmt::format("the job stopped on an unforeseen error ({}), which is a bug; report it",
                    thrown.what()));
  }
}

/// Returns the memory of a calibration to the system. Otherwise glibc keeps it in fragments between
/// the allocations that stay, and every calibration adds some.
Result<JobOutcome> done_and_tidied(const DoJob& work, const StoredJob& job, JobWatch& watch) {
  auto outcome = done_safely(work, job, watch);
  ::malloc_trim(0);
  return outcome;
}

/// The newest accepted calibration that says something of the months; an accepted one may lack it.
Result<std::optional<StoredJob>> last_followed(Store& store) {
  constexpr int kLookedAt = 24;
  const auto jobs = TRY(store.jobs(JobKind::calibration, kLookedAt));
  for (const StoredJob& one : jobs) {
    if (one.state != JobState::done || !one.accepted) continue;
    auto job = store.job(one.number);
    if (!job) return job;
    if (*job && (*job)->result.drift) return job;
  }
  return std::optional<StoredJob>{};
}

}  // namespace

JobRunner::JobRunner(Ports ports, DoJob work, OnJob on_job, OnJobEvent on_event)
    : ports_(ports),
      work_(std::move(work)),
      on_job_(std::move(on_job)),
      on_event_(std::move(on_event)),
      watch_(std::make_shared<JobWatch>()) {}

JobRunner::~JobRunner() { watch_->stop(); }

void JobRunner::interrupt() {
  watch_->stop();
  if (stage_ != Stage::running) return;
  StoredJob job = current_;
  job.state = JobState::waiting;
  job.started.reset();
  --job.tries;  // this attempt does not count
  // If the store refuses, the job looks like one left by a killed process, and runs again.
  (void)ports_.store.put_job(job);
}

void JobRunner::resume() {
  if (!take_up_unfinished()) return try_later(&JobRunner::resume);
  begin_next();
}

Result<void> JobRunner::take_up_unfinished() {
  auto unfinished = TRY(ports_.store.unfinished_jobs());
  std::set<JobKind> waiting;
  for (StoredJob& job : unfinished) {
    if (job.state == JobState::running && job.tries >= kTriesMax) {
      job.message = fmt::format(
          "recald was killed {} times while the job ran, perhaps by the system because memory ran "
          "out; make more memory available, then request the job again",
          job.tries);
      if (auto put = end(std::move(job), JobState::failed); !put) return put;
    } else if (!waiting.insert(job.kind).second) {
      job.message = "an earlier request is still waiting and will use the same readings";
      if (auto put = end(std::move(job), JobState::cancelled); !put) return put;
    } else if (job.state == JobState::running) {
      job.state = JobState::waiting;
      job.started.reset();
      if (auto put = ports_.store.put_job(job); !put) return put;
    }
  }
  return {};
}

Result<void> JobRunner::end(StoredJob job, JobState state) {
  job.state = state;
  job.ended = ports_.loop.now().instant();
  if (auto put = put_with_events(job, false); !put) return put;
  if (on_job_) on_job_(job);
  return {};
}

/// A job that is stored as ended says nothing more, so its events are stored in the same commit.
Result<void> JobRunner::put_with_events(const StoredJob& job, bool has_named) {
  const auto before = TRY(last_followed(ports_.store));
  const std::vector<StoreEvent> events = events_of(job, has_named, before);
  auto put = ports_.store.as_one([&]() -> Result<void> {
    if (const StoreBatch batch{.events = events}; !batch.empty()) {
      TRY(ports_.store.commit(batch));
    }
    return ports_.store.put_job(job);
  });
  if (put && on_event_) std::ranges::for_each(events, on_event_);
  return put;
}

Result<std::int64_t> JobRunner::ask(JobKind kind, const std::string& asked_by) {
  const auto unfinished = TRY(ports_.store.unfinished_jobs());
  const auto same = std::ranges::find_if(unfinished, [&](const StoredJob& job) {
    return job.kind == kind && job.state == JobState::waiting;
  });
  if (same != unfinished.end()) return same->number;
  StoredJob job{.kind = kind, .asked_by = asked_by, .asked = ports_.loop.now().instant()};
  const auto number = ports_.store.add_job(job);
  if (!number) return number;
  job.number = *number;
  if (on_job_) on_job_(job);
  begin_next();
  return number;
}

Result<void> JobRunner::cancel(std::int64_t number) {
  if (stage_ == Stage::running && current_.number == number) {
    cancelled_ = true;
    watch_->stop();
    return {};
  }
  auto found = TRY(ports_.store.job(number));
  if (!found || found->state != JobState::waiting) {
    return failure(ErrorCode::not_found, fmt::format("no job {} is waiting or running", number));
  }
  return end(std::move(*found), JobState::cancelled);
}

std::optional<JobProgress> JobRunner::progress() const {
  if (stage_ != Stage::running) return std::nullopt;
  const auto progress = watch_->progress();
  if (!progress) return std::nullopt;
  return JobProgress{current_.number, progress->share, progress->what};
}

void JobRunner::begin_next() {
  if (stage_ != Stage::idle) return;
  const auto unfinished = ports_.store.unfinished_jobs();
  if (!unfinished) return try_later(&JobRunner::begin_next);
  if (unfinished->empty()) return;
  current_ = unfinished->front();
  current_.state = JobState::running;
  current_.started = ports_.loop.now().instant();
  ++current_.tries;
  if (!ports_.store.put_job(current_)) return try_later(&JobRunner::begin_next);
  if (on_job_) on_job_(current_);
  stage_ = Stage::running;
  cancelled_ = false;
  watch_ = std::make_shared<JobWatch>();

  // The work may outlive this object, so it has copies of everything it uses.
  const auto outcome = std::make_shared<Result<JobOutcome>>();
  ports_.worker.run([work = work_, job = current_, outcome,
                     watch = watch_] { *outcome = done_and_tidied(work, job, *watch); },
                    alive_.guard([this, outcome] { finish(std::move(*outcome)); }));
}

void JobRunner::finish(Result<JobOutcome> outcome) {
  current_.ended = ports_.loop.now().instant();
  if (outcome) {
    current_.state = outcome->failed ? JobState::failed : JobState::done;
    current_.accepted = outcome->accepted;
    current_.message = std::move(outcome->message);
    current_.folder = std::move(outcome->folder);
    current_.result = std::move(outcome->result);
    forecasts_ = std::move(outcome->forecasts);
    has_named_ = outcome->named;
    next_ = outcome->next;
    next_asked_by_ = std::move(outcome->next_asked_by);
  } else {
    current_.state = cancelled_ ? JobState::cancelled : JobState::failed;
    current_.message = cancelled_ ? "" : outcome.error().message;
    has_named_ = false;
  }
  stage_ = Stage::keeping;
  keep();
}

/// Keeps trying, so that a result survives a disk that is full for a while.
void JobRunner::keep() {
  // The job comes last: if the process ends in between, the job runs again and the rest
  // is already stored.
  const bool is_kept = ports_.store.add_forecasts(forecasts_) &&
                       (!next_ || ask(*next_, next_asked_by_)) &&
                       put_with_events(current_, has_named_);
  if (is_kept) {
    forecasts_.clear();
    next_.reset();
    stage_ = Stage::idle;
    if (on_job_) on_job_(current_);
    begin_next();
    return;
  }
  try_later(&JobRunner::keep);
}

void JobRunner::try_later(void (JobRunner::*step)()) {
  ports_.loop.after(kTryAgain, alive_.guard([this, step] { (this->*step)(); }));
}

}  // namespace recald::daemon
