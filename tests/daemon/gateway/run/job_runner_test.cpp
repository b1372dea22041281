/// Jobs on the virtual clock: nothing that was asked for is lost, one runs at a time, and the store
/// tells how each ended.
#include "daemon/gateway/run/job_runner.hpp"

#include <gmock/gmock.h>

#include "adapters/sqlite/sqlite_store.hpp"
#include "tests/support/failing_store.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/virtual_loop.hpp"
#include "tests/support/virtual_worker.hpp"

namespace recald::daemon::job_runner_test {
namespace {

using recald::testing::FailingStore;
using recald::testing::TemporaryFolder;
using recald::testing::VirtualLoop;
using recald::testing::VirtualWorker;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class JobRunnerTest : public ::testing::Test {
 protected:
  JobRunnerTest() { begin_process(); }

  /// As a new process on the same store.
  void begin_process() {
    runner_.reset();
    failing_.reset();
    store_.reset();
    loop_ = std::make_unique<VirtualLoop>(std::chrono::sys_days{std::chrono::year{2026} / 2 / 1} +
                                          hours{processes_++});
    worker_ = std::make_unique<VirtualWorker>(*loop_, minutes{1});
    store_ = std::make_unique<sqlite::SqliteStore>(
        std::move(*sqlite::SqliteStore::open(folder_ / "site.db")));
    failing_ = std::make_unique<FailingStore>(*store_);
    runner_ = std::make_unique<JobRunner>(
        JobRunner::Ports{*loop_, *failing_, *worker_},
        [this](const StoredJob& job, metering::Instant, JobWatch& watch) {
          return work(job, watch);
        },
        [this](const StoredJob& job) {
          told_.push_back(std::to_string(job.number) + " " + std::string{name_of(job.state)});
        });
  }
  void kill_process() { begin_process(); }

  Result<JobOutcome> work(const StoredJob& job, JobWatch& watch) {
    ++runs_;
    if (says_ > 0.0) {
      watch.say("calibrating", says_);
      seen_ = runner_->progress();
    }
    if (!throws_.empty()) throw std::runtime_error(throws_);
    if (!watch.goes_on()) return failure(ErrorCode::cancelled, "told to stop");
    if (fails_) return failure(ErrorCode::not_enough_data, "no month has closed yet");
    return JobOutcome{.accepted = accepts_,
                      .message = accepts_ ? "" : "not converged",
                      .folder = "calibration-" + std::to_string(job.number),
                      .result = {.document = "{\"job\": " + std::to_string(job.number) + "}"},
                      .forecasts = forecasts_,
                      .next = job.kind == JobKind::calibration ? next_ : std::nullopt};
  }
  std::int64_t ask(JobKind kind = JobKind::calibration) {
    const auto number = runner_->ask(kind, "api");
    EXPECT_TRUE(number.has_value()) << number.error().message;
    return number.value_or(-1);
  }
  StoredJob stored(std::int64_t number) {
    const auto found = store_->job(number);
    EXPECT_TRUE(found.has_value() && found->has_value()) << number;
    return found.value_or(std::nullopt).value_or(StoredJob{});
  }

  TemporaryFolder folder_;
  int processes_ = 0;
  int runs_ = 0;
  double says_ = 0.0;
  std::optional<JobProgress> seen_;  ///< While it ran.
  bool fails_ = false;
  std::string throws_;
  bool accepts_ = true;
  std::vector<StoredForecast> forecasts_;
  std::optional<JobKind> next_;
  std::vector<std::string> told_;
  std::unique_ptr<VirtualLoop> loop_;
  std::unique_ptr<VirtualWorker> worker_;
  std::unique_ptr<sqlite::SqliteStore> store_;
  std::unique_ptr<FailingStore> failing_;
  std::unique_ptr<JobRunner> runner_;
};

TEST_F(JobRunnerTest, AJobRunsAndItsResultIsKept) {
  const std::int64_t number = ask();
  loop_->run_for(minutes{2});
  const StoredJob job = stored(number);
  EXPECT_EQ(job.state, JobState::done);
  EXPECT_TRUE(job.accepted);
  EXPECT_EQ(job.folder, "calibration-1");
  EXPECT_EQ(job.result.document, "{\"job\": 1}");
  ASSERT_TRUE(job.started && job.ended);
  EXPECT_EQ(*job.ended - *job.started, minutes{1});
  EXPECT_THAT(told_, ElementsAre("1 waiting", "1 running", "1 done"));
}

TEST_F(JobRunnerTest, ForecastsAreKeptAndWhatTheResultGivesReasonForIsAskedFor) {
  forecasts_ = {{.output = "main_daily_kWh", .month = std::chrono::year{2026} / 1}};
  next_ = JobKind::diagnosis;
  ask();
  failing_->refuses = true;  // a full disk, just when the calibration ends
  loop_->run_for(seconds{70});
  failing_->refuses = false;
  loop_->run_for(minutes{3});
  EXPECT_EQ(stored(1).state, JobState::done);
  EXPECT_EQ(stored(2).kind, JobKind::diagnosis);
  EXPECT_EQ(stored(2).asked_by, "drift");
  EXPECT_EQ(stored(2).state, JobState::done);
  EXPECT_EQ(store_->forecasts().value().size(), 1U);
  EXPECT_EQ(runs_, 2);  // a diagnosis gives no reason for another
}

// Whoever is told of a failed job by its event must not miss it for a full disk.
TEST_F(JobRunnerTest, ItsEventIsStoredTogetherWithIt) {
  fails_ = true;
  ask();
  failing_->refuses = true;
  loop_->run_for(seconds{70});
  EXPECT_TRUE(store_->events(10)->empty());
  failing_->refuses = false;
  loop_->run_for(minutes{1});
  const auto events = store_->events(10).value();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, "calibration_failed");
  EXPECT_THAT(events[0].text, HasSubstr("no month has closed yet"));
  EXPECT_EQ(stored(1).state, JobState::failed);
}

TEST_F(JobRunnerTest, ARunningJobSaysHowFarItIs) {
  JobWatch watch;
  EXPECT_FALSE(watch.progress().has_value());
  EXPECT_TRUE(watch.say("calibrating", 0.4));
  watch.say("calibrating again", 0.2);  // no nearer to its end
  EXPECT_EQ(watch.progress()->share, 0.4);
  EXPECT_EQ(watch.progress()->what, "calibrating again");
  watch.stop();
  EXPECT_FALSE(watch.say("following", 0.6));

  EXPECT_FALSE(runner_->progress().has_value());
  says_ = 0.3;
  const std::int64_t job = ask();
  loop_->run_for(minutes{2});
  ASSERT_TRUE(seen_.has_value());
  EXPECT_EQ(seen_->job, job);
  EXPECT_EQ(seen_->share, 0.3);
  EXPECT_FALSE(runner_->progress().has_value());
}

TEST_F(JobRunnerTest, OneAtATimeInTheOrderOfAsking) {
  ask();
  ask(JobKind::diagnosis);
  loop_->run_for(seconds{90});
  EXPECT_EQ(stored(1).state, JobState::done);
  EXPECT_EQ(stored(2).state, JobState::running);
  loop_->run_for(minutes{1});
  EXPECT_EQ(stored(2).state, JobState::done);
}

TEST_F(JobRunnerTest, WhoAsksForWhatWaitsAlreadyGetsItsNumber) {
  EXPECT_EQ(ask(), 1);  // runs at once
  EXPECT_EQ(ask(), 2);  // what runs may have read too little
  EXPECT_EQ(ask(), 2);
  EXPECT_EQ(ask(JobKind::diagnosis), 3);
  EXPECT_EQ(ask(), 2);
}

TEST_F(JobRunnerTest, AFailureIsKeptInWordsAndTheNextOneRuns) {
  fails_ = true;
  const std::int64_t failing = ask();
  loop_->run_for(minutes{2});
  EXPECT_EQ(stored(failing).state, JobState::failed);
  EXPECT_THAT(stored(failing).message, HasSubstr("no month has closed"));
  fails_ = false;
  const std::int64_t next = ask();
  loop_->run_for(minutes{2});
  EXPECT_EQ(stored(next).state, JobState::done);
}

TEST_F(JobRunnerTest, AResultThatFailsItsGateIsKeptAndNotUsed) {
  const std::int64_t good = ask();
  loop_->run_for(minutes{2});
  accepts_ = false;
  const std::int64_t bad = ask();
  loop_->run_for(minutes{2});
  EXPECT_EQ(stored(bad).state, JobState::done);
  EXPECT_EQ(stored(bad).message, "not converged");
  const auto used = store_->last_accepted(JobKind::calibration);
  ASSERT_TRUE(used.has_value() && used->has_value());
  EXPECT_EQ((*used)->number, good);
}

TEST_F(JobRunnerTest, ARunningJobThatIsCancelledEndsAndTheNextOneRuns) {
  const std::int64_t running = ask();
  const std::int64_t waiting = ask(JobKind::diagnosis);
  loop_->run_for(seconds{10});
  ASSERT_TRUE(runner_->cancel(running).has_value());
  loop_->run_for(minutes{3});
  EXPECT_EQ(stored(running).state, JobState::cancelled);
  EXPECT_EQ(stored(waiting).state, JobState::done);
}

TEST_F(JobRunnerTest, AWaitingJobThatIsCancelledNeverRuns) {
  ask();
  const std::int64_t waiting = ask(JobKind::diagnosis);
  ASSERT_TRUE(runner_->cancel(waiting).has_value());
  loop_->run_for(minutes{5});
  EXPECT_EQ(stored(waiting).state, JobState::cancelled);
  EXPECT_EQ(runs_, 1);
}

TEST_F(JobRunnerTest, WhatIsOverCannotBeCancelled) {
  const std::int64_t number = ask();
  loop_->run_for(minutes{2});
  for (const std::int64_t over : {number, std::int64_t{77}}) {
    const auto cancelled = runner_->cancel(over);
    ASSERT_FALSE(cancelled.has_value());
    EXPECT_EQ(cancelled.error().code, ErrorCode::not_found);
  }
}

// Wherever the process ends, the next one does what was asked for, once.
TEST_F(JobRunnerTest, AKilledProcessLosesNoJobAndRepeatsNone) {
  for (const seconds killed_after : {seconds{0}, seconds{30}, seconds{90}, seconds{150}}) {
    SCOPED_TRACE(killed_after.count());
    const std::int64_t first = ask();
    const std::int64_t second = ask(JobKind::diagnosis);
    loop_->run_for(killed_after);
    const int runs_before = runs_;
    const int done_before = (stored(first).state == JobState::done ? 1 : 0) +
                            (stored(second).state == JobState::done ? 1 : 0);
    kill_process();
    runner_->resume();
    loop_->run_for(minutes{5});
    EXPECT_EQ(stored(first).state, JobState::done);
    EXPECT_EQ(stored(second).state, JobState::done);
    EXPECT_EQ(runs_ - runs_before, 2 - done_before);
  }
}

// A job that has the whole process killed would do so for ever.
TEST_F(JobRunnerTest, AfterThreeKillsAJobIsGivenUp) {
  const std::int64_t number = ask();
  for (int kill = 1; kill <= 3; ++kill) {
    loop_->run_for(seconds{30});
    EXPECT_EQ(stored(number).state, JobState::running);
    kill_process();
    runner_->resume();
  }
  loop_->run_for(hours{1});
  EXPECT_EQ(stored(number).state, JobState::failed);
  EXPECT_THAT(stored(number).message, HasSubstr("was killed 3 times while the job ran"));
  EXPECT_EQ(told_.back(), "1 failed");
  EXPECT_EQ(runs_, 0);
}

TEST_F(JobRunnerTest, EndingTheProcessInGoodOrderCountsAgainstNoJob) {
  const std::int64_t number = ask();
  for (int end = 1; end <= 5; ++end) {
    loop_->run_for(seconds{30});
    runner_->interrupt();
    EXPECT_EQ(stored(number).state, JobState::waiting);
    kill_process();
    runner_->resume();
  }
  loop_->run_for(seconds{30});
  kill_process();  // in no good order: the first of three
  runner_->resume();
  loop_->run_for(hours{1});
  EXPECT_EQ(stored(number).state, JobState::done);
}

TEST_F(JobRunnerTest, WhatAJobThrowsIsWhyItFailed) {
  throws_ = "a matrix that nobody expected";
  const std::int64_t number = ask();
  const std::int64_t next = ask(JobKind::diagnosis);
  loop_->run_for(seconds{90});
  EXPECT_EQ(stored(number).state, JobState::failed);
  EXPECT_THAT(stored(number).message, HasSubstr("a matrix that nobody expected"));
  throws_.clear();
  loop_->run_for(minutes{5});
  EXPECT_EQ(stored(next).state, JobState::done);
}

TEST_F(JobRunnerTest, OfAKindOneWaitsAtMost) {
  const std::int64_t first = ask();
  loop_->run_for(seconds{30});
  const std::int64_t second = ask();
  EXPECT_EQ(ask(), second);
  kill_process();  // the first has to run again, and the second would see nothing else
  runner_->resume();
  loop_->run_for(hours{1});
  EXPECT_EQ(stored(first).state, JobState::done);
  EXPECT_EQ(stored(second).state, JobState::cancelled);
  EXPECT_THAT(stored(second).message, HasSubstr("is still waiting"));
}

TEST_F(JobRunnerTest, AFullDiskDelaysAResultAndLosesNone) {
  const std::int64_t number = ask();
  const std::int64_t next = ask(JobKind::diagnosis);
  loop_->run_for(seconds{30});
  failing_->refuses = true;
  loop_->run_for(minutes{5});
  EXPECT_EQ(stored(number).state, JobState::running);
  EXPECT_FALSE(runner_->ask(JobKind::calibration, "api").has_value());
  failing_->refuses = false;
  loop_->run_for(minutes{3});
  EXPECT_EQ(stored(number).state, JobState::done);
  EXPECT_EQ(stored(next).state, JobState::done);
  EXPECT_EQ(runs_, 2);
}

TEST_F(JobRunnerTest, AJobThatCannotBeginWaitsForTheStore) {
  ask();
  ask(JobKind::diagnosis);
  kill_process();
  failing_->refuses = true;
  runner_->resume();
  failing_->refuses = false;
  loop_->run_for(seconds{10});
  loop_->run_for(minutes{5});
  EXPECT_EQ(stored(1).state, JobState::done);
  EXPECT_EQ(stored(2).state, JobState::done);
}

}  // namespace
}  // namespace recald::daemon::job_runner_test
