#include "daemon/gateway/run/job_runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace recald::daemon {
namespace {

constexpr std::chrono::seconds kTryAgain{10};

}  // namespace

JobRunner::JobRunner(Ports ports, DoJob work, OnJob on_job)
    : ports_(ports),
      work_(std::move(work)),
      on_job_(std::move(on_job)),
      running_goes_on_(std::make_shared<std::atomic<bool>>(true)),
      self_(std::make_shared<JobRunner*>(this)) {}

JobRunner::~JobRunner() { interrupt(); }

Result<void> JobRunner::resume() {
  auto unfinished = ports_.store.unfinished_jobs();
  if (!unfinished) return tl::unexpected(unfinished.error());
  for (StoredJob& job : *unfinished) {
    if (job.state != JobState::running) continue;
    job.state = JobState::waiting;
    job.started.reset();
    if (auto put = ports_.store.put_job(job); !put) return put;
  }
  begin_next();
  return {};
}

Result<std::int64_t> JobRunner::ask(JobKind kind, const std::string& asked_by) {
  const auto unfinished = ports_.store.unfinished_jobs();
  if (!unfinished) return tl::unexpected(unfinished.error());
  const auto same = std::ranges::find_if(*unfinished, [&](const StoredJob& job) {
    return job.kind == kind && job.state == JobState::waiting;
  });
  if (same != unfinished->end()) return same->number;
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
    running_goes_on_->store(false);
    return {};
  }
  auto found = ports_.store.job(number);
  if (!found) return tl::unexpected(found.error());
  if (!*found || (*found)->state != JobState::waiting) {
    return failure(ErrorCode::not_found, fmt::format("no job {} waits or runs", number));
  }
  StoredJob job = std::move(**found);
  job.state = JobState::cancelled;
  job.ended = ports_.loop.now().instant();
  if (auto put = ports_.store.put_job(job); !put) return put;
  if (on_job_) on_job_(job);
  return {};
}

void JobRunner::begin_next() {
  if (stage_ != Stage::idle) return;
  const auto unfinished = ports_.store.unfinished_jobs();
  if (!unfinished) return try_later(&JobRunner::begin_next);
  if (unfinished->empty()) return;
  current_ = unfinished->front();
  current_.state = JobState::running;
  current_.started = ports_.loop.now().instant();
  if (!ports_.store.put_job(current_)) return try_later(&JobRunner::begin_next);
  if (on_job_) on_job_(current_);
  stage_ = Stage::running;
  cancelled_ = false;
  running_goes_on_ = std::make_shared<std::atomic<bool>>(true);

  // The work may outlive this: it has copies of all it uses.
  const auto outcome = std::make_shared<Result<JobOutcome>>();
  ports_.worker.run(
      [work = work_, job = current_, outcome, goes_on = running_goes_on_] {
        *outcome = work(job, *job.started, [goes_on] { return goes_on->load(); });
      },
      [weak = std::weak_ptr{self_}, outcome] {
        if (const auto self = weak.lock()) (*self)->finish(std::move(*outcome));
      });
}

void JobRunner::finish(Result<JobOutcome> outcome) {
  current_.ended = ports_.loop.now().instant();
  if (outcome) {
    current_.state = JobState::done;
    current_.accepted = outcome->accepted;
    current_.message = std::move(outcome->message);
    current_.folder = std::move(outcome->folder);
    current_.result = std::move(outcome->result);
    forecasts_ = std::move(outcome->forecasts);
    next_ = outcome->next;
  } else {
    current_.state = cancelled_ ? JobState::cancelled : JobState::failed;
    current_.message = cancelled_ ? "" : outcome.error().message;
  }
  stage_ = Stage::keeping;
  keep();
}

/// A result is not lost to a disk that is full for a while.
void JobRunner::keep() {
  // The job last: if the process ends in between it is done again, and the rest is there already.
  const bool is_kept = ports_.store.add_forecasts(forecasts_) && (!next_ || ask(*next_, "drift")) &&
                       ports_.store.put_job(current_);
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
  ports_.loop.after(kTryAgain, [weak = std::weak_ptr{self_}, step] {
    if (const auto self = weak.lock()) ((*self)->*step)();
  });
}

}  // namespace recald::daemon
