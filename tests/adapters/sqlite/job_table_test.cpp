/// Jobs outlive the process: what was asked for, how far it got, and what came of it.
#include <gmock/gmock.h>

#include <fstream>

#include "adapters/sqlite/sqlite_store.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::sqlite::job_table_test {
namespace {

using metering::Instant;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;

const Instant kAsked = std::chrono::sys_days{std::chrono::year{2026} / 2 / 1};

class JobTable : public ::testing::Test {
 protected:
  void SetUp() override { reopen(); }
  void reopen() {
    store_.reset();
    auto opened = SqliteStore::open(folder_ / "site.db");
    ASSERT_TRUE(opened.has_value()) << opened.error().message;
    store_ = std::make_unique<SqliteStore>(std::move(*opened));
  }
  std::int64_t add(JobKind kind, JobState state = JobState::waiting, bool accepted = false) {
    StoredJob job{.kind = kind, .state = state, .asked_by = "api", .asked = kAsked};
    job.accepted = accepted;
    job.result.document = "{}";
    return store_->add_job(job).value_or(-1);
  }

  recald::testing::TemporaryFolder folder_;
  std::unique_ptr<SqliteStore> store_;
};

TEST_F(JobTable, EveryPartOfAJobIsThereAfterARestart) {
  StoredJob job{.kind = JobKind::diagnosis,
                .state = JobState::done,
                .asked_by = "month",
                .asked = kAsked,
                .started = kAsked + std::chrono::seconds{1},
                .ended = kAsked + std::chrono::seconds{60}};
  job.accepted = true;
  job.message = "R-hat 1.2 of heat gains";
  job.folder = "diagnosis-1";
  job.result.document = R"({"outcome": "none"})";
  const auto number = store_->add_job(job);
  ASSERT_TRUE(number.has_value()) << number.error().message;
  reopen();
  const auto found = store_->job(*number);
  ASSERT_TRUE(found.has_value() && found->has_value());
  const StoredJob& kept = **found;
  EXPECT_EQ(kept.number, *number);
  EXPECT_EQ(kept.kind, job.kind);
  EXPECT_EQ(kept.state, job.state);
  EXPECT_EQ(kept.asked_by, job.asked_by);
  EXPECT_EQ(kept.asked, job.asked);
  EXPECT_EQ(kept.started, job.started);
  EXPECT_EQ(kept.ended, job.ended);
  EXPECT_EQ(kept.accepted, job.accepted);
  EXPECT_EQ(kept.message, job.message);
  EXPECT_EQ(kept.folder, job.folder);
  EXPECT_EQ(kept.result.document, job.result.document);
}

TEST_F(JobTable, AJobThatHasNotBegunHasNoTimes) {
  const auto found = store_->job(add(JobKind::calibration));
  ASSERT_TRUE(found.has_value() && found->has_value());
  EXPECT_FALSE((*found)->started.has_value());
  EXPECT_FALSE((*found)->ended.has_value());
}

TEST_F(JobTable, NumbersAreNeverGivenTwice) {
  EXPECT_EQ(add(JobKind::calibration), 1);
  EXPECT_EQ(add(JobKind::diagnosis), 2);
  ASSERT_TRUE(store_->database().execute("DELETE FROM job WHERE number = 2").has_value());
  EXPECT_EQ(add(JobKind::calibration), 3);
}

TEST_F(JobTable, AskedForANumberThatWasNeverGivenThereIsNone) {
  const auto found = store_->job(7);
  ASSERT_TRUE(found.has_value());
  EXPECT_FALSE(found->has_value());
  StoredJob unknown;
  unknown.number = 7;
  const auto put = store_->put_job(unknown);
  ASSERT_FALSE(put.has_value());
  EXPECT_EQ(put.error().code, ErrorCode::not_found);
}

TEST_F(JobTable, ListsOneKindNewestFirst) {
  add(JobKind::calibration);
  add(JobKind::diagnosis);
  add(JobKind::calibration);
  add(JobKind::calibration);
  const auto jobs = store_->jobs(JobKind::calibration, 2);
  ASSERT_TRUE(jobs.has_value());
  EXPECT_THAT(*jobs, ElementsAre(Field(&StoredJob::number, 4), Field(&StoredJob::number, 3)));
}

TEST_F(JobTable, TheLastGoodResultStaysInUseWhenALaterOneFailsItsGates) {
  const std::int64_t good = add(JobKind::calibration, JobState::done, true);
  add(JobKind::calibration, JobState::done, false);
  add(JobKind::diagnosis, JobState::done, true);
  const auto last = store_->last_accepted(JobKind::calibration);
  ASSERT_TRUE(last.has_value() && last->has_value());
  EXPECT_EQ((*last)->number, good);
  EXPECT_EQ((*last)->result.document, "{}");
}

TEST_F(JobTable, WhatWaitsOrRunsIsFoundAgainInTheOrderOfAsking) {
  add(JobKind::calibration, JobState::done);
  const std::int64_t running = add(JobKind::diagnosis, JobState::running);
  add(JobKind::calibration, JobState::failed);
  add(JobKind::calibration, JobState::cancelled);
  const std::int64_t waiting = add(JobKind::calibration);
  reopen();
  const auto unfinished = store_->unfinished_jobs();
  ASSERT_TRUE(unfinished.has_value());
  EXPECT_THAT(*unfinished,
              ElementsAre(Field(&StoredJob::number, running), Field(&StoredJob::number, waiting)));

  StoredJob finished = unfinished->front();
  finished.state = JobState::done;
  ASSERT_TRUE(store_->put_job(finished).has_value());
  finished = unfinished->back();
  finished.state = JobState::cancelled;
  ASSERT_TRUE(store_->put_job(finished).has_value());
  const auto none = store_->unfinished_jobs();
  ASSERT_TRUE(none.has_value());
  EXPECT_THAT(*none, IsEmpty());
}

// A store of version 1 had no jobs; what it had is still there.
TEST_F(JobTable, AStoreFromBeforeJobsIsUpgraded) {
  const auto number = store_->meter_number("main", std::chrono::seconds{900});
  ASSERT_TRUE(number.has_value());
  const auto made_old = store_->database().execute(
      "ALTER TABLE interval DROP COLUMN edit; DROP TABLE edit; DROP TABLE job;"
      "DROP TABLE forecast; DROP TABLE closing; DROP TABLE cursor; DROP TABLE outbox;"
      "ALTER TABLE event DROP COLUMN count; ALTER TABLE event DROP COLUMN last;"
      "ALTER TABLE event DROP COLUMN sum; ALTER TABLE meter DROP COLUMN sum;"
      "ALTER TABLE interval DROP COLUMN sum; ALTER TABLE register DROP COLUMN sum;"
      "ALTER TABLE sample DROP COLUMN sum; ALTER TABLE month DROP COLUMN sum;"
      "PRAGMA user_version = 1");
  ASSERT_TRUE(made_old.has_value()) << made_old.error().message;
  reopen();
  EXPECT_EQ(add(JobKind::calibration), 1);
  const auto same = store_->meter_number("main", std::chrono::seconds{900});
  ASSERT_TRUE(same.has_value());
  EXPECT_EQ(*same, *number);
}

}  // namespace
}  // namespace recald::sqlite::job_table_test
