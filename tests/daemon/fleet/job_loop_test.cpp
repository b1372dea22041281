/// What becomes of jobs whatever their processes do, with a real PostgreSQL and real processes.
#include "daemon/fleet/work/job_loop.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <mutex>
#include <thread>

#include "daemon/fleet/work/work_folder.hpp"
#include "tests/adapters/record/record_fixture.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using record::FleetJob;
using record::FleetJobState;
using record::month_of;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr auto kOutcome =
    R"({"failed":"","accepted":true,"named":false,"message":"","folder":"work/results","next":null,)"
    R"("next_asked_by":"","versions":"site.models","summary":{"outputs":[]}})";

class JobLoopTest : public record::Record {
 protected:
  /// Closes March of a site, so that it has a job.
  void ask_job(const std::string& site) {
    ASSERT_TRUE(record::put_site(*connection_, record::described(site), "ann"));
    record::RecordBatch batch{.outbox = 11};
    batch.entries.push_back(record::interval_entry(1, "steam", record::kMarch, 5.0));
    std::int64_t number = 1;
    for (const char* meter : {"steam", "power"}) {
      batch.entries.push_back(record::month_entry(++number, meter, month_of(2024, 3), 1.0));
    }
    ASSERT_TRUE(send(batch, site)) << site;
  }

  /// A program in the place of recald, which does what the script says; $3 is the job's folder.
  [[nodiscard]] JobLoop loop(const std::string& script) {
    const auto program = folder_ / "program";
    recald::testing::write_text(program, "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    std::filesystem::create_directories(folder_ / "jobs");
    return {.record = {.url = url_, .password_file = {}},
            .worker = {.jobs = 1, .folder = folder_ / "jobs"},
            .name = "here",
            .program = program,
            .rules = {.wait_after_try = std::chrono::seconds{0}},
            .ends_when_idle = true};
  }
  [[nodiscard]] static std::string leaves(const std::string& outcome) {
    return "mkdir -p $3/work/results $3/work/site.models; printf page > "
           "$3/work/results/report.html; "
           "printf draws > $3/work/results/draws_1.csv; printf v1 > $3/work/site.models/active; "
           "printf '%s' '" +
           outcome + "' > $3/outcome.json";
  }

  [[nodiscard]] int run(const JobLoop& loop) {
    return do_jobs(loop, [this](const std::string& words) { told_.push_back(words); }, {});
  }
  [[nodiscard]] FleetJob job_of(const std::string& site) const {
    return record::jobs(*connection_, site, 1).value().at(0);
  }

  recald::testing::TemporaryFolder folder_;
  std::vector<std::string> told_;
};

TEST_F(JobLoopTest, KeepsWhatAJobLeavesButItsDraws) {
  ask_job("tower");
  EXPECT_EQ(run(loop(leaves(kOutcome))), 1);
  EXPECT_EQ(job_of("tower").state, FleetJobState::done);
  const auto results = record::newest_results(*connection_, JobKind::calibration).value();
  ASSERT_EQ(results.size(), 1u);
  EXPECT_TRUE(results[0].accepted);
  EXPECT_THAT(results[0].files, ::testing::ElementsAre("report.html"));
  EXPECT_EQ(record::result_file(*connection_, "tower", JobKind::calibration, month_of(2024, 3),
                                "report.html"),
            "page");
  // The next job begins with the versions that this one left.
  EXPECT_EQ(ask("SELECT n.name FROM site_state n"), "site.models/active\n");
  EXPECT_THAT(told_, Contains(HasSubstr("calibration of tower for 2024-03 done in")));
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "jobs"));
}

TEST_F(JobLoopTest, GivesAProcessTheSitesFilesAndItsStore) {
  ask_job("tower");
  const std::string script = "cat $3/site/site.toml > " + (folder_ / "seen").string() +
                             "; ls $3/work >> " + (folder_ / "seen").string() +
                             "; ls $3/site/weather >> " + (folder_ / "seen").string() +
                             "; grep -o '\"kind\": \"[a-z]*\"' $3/job.json >> " +
                             (folder_ / "seen").string() + "; " + leaves(kOutcome);
  EXPECT_EQ(run(loop(script)), 1);
  const std::string seen = recald::testing::read_text(folder_ / "seen");
  EXPECT_THAT(seen, AllOf(HasSubstr("id = 1"), HasSubstr("store.db"), HasSubstr("city.epw"),
                          HasSubstr("\"kind\": \"calibration\"")));
}

TEST_F(JobLoopTest, AJobThatKillsItsProcessIsSetAsideAndOthersGoOn) {
  for (const char* site : {"tower", "poison", "annex"}) ask_job(site);
  const auto with_poison =
      loop("grep -q '\"site\": \"poison\"' $3/job.json && kill -9 $$\n" + leaves(kOutcome));
  EXPECT_EQ(run(with_poison), 2);
  EXPECT_EQ(job_of("tower").state, FleetJobState::done);
  EXPECT_EQ(job_of("annex").state, FleetJobState::done);
  const FleetJob poison = job_of("poison");
  EXPECT_EQ(poison.state, FleetJobState::set_aside);
  EXPECT_EQ(poison.tries, 3);
  EXPECT_THAT(poison.reason, HasSubstr("killed by signal 9"));
}

TEST_F(JobLoopTest, WhatTakesTooLongOrLeavesNothingIsNoResult) {
  ask_job("tower");
  JobLoop slow = loop("sleep 30");
  slow.worker.time_max = std::chrono::seconds{1};
  slow.rules.tries_max = 1;
  EXPECT_EQ(run(slow), 0);
  EXPECT_EQ(job_of("tower").state, FleetJobState::set_aside);
  EXPECT_THAT(job_of("tower").reason, HasSubstr("longer than 1 s"));
  ask_job("annex");
  JobLoop silent = loop("true");
  silent.rules.tries_max = 1;
  EXPECT_EQ(run(silent), 0);
  EXPECT_EQ(job_of("annex").state, FleetJobState::set_aside);
}

TEST_F(JobLoopTest, AJobThatCannotBeDoneFailsAtOnceWithItsReason) {
  ask_job("tower");
  EXPECT_EQ(run(loop(leaves(R"({"failed":"there are 3 months, and 12 are needed"})"))), 1);
  EXPECT_EQ(job_of("tower").state, FleetJobState::failed);
  EXPECT_EQ(job_of("tower").tries, 1);
  EXPECT_EQ(job_of("tower").reason, "there are 3 months, and 12 are needed");
}

TEST_F(JobLoopTest, AWorkerThatStopsHandsItsJobBackAtOnce) {
  ask_job("tower");
  JobLoop endless = loop("touch " + (folder_ / "begun").string() + "; sleep 60");
  std::jthread worker{[&](const std::stop_token& stop) {
    (void)do_jobs(
        endless, [](auto&) {}, stop);
  }};
  for (int i = 0; i < 200 && !std::filesystem::exists(folder_ / "begun"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
  }
  ASSERT_TRUE(std::filesystem::exists(folder_ / "begun"));
  worker.request_stop();
  worker.join();
  EXPECT_EQ(job_of("tower").state, FleetJobState::waiting);
  EXPECT_EQ(job_of("tower").tries, 0);
  EXPECT_EQ(run(loop(leaves(kOutcome))), 1);
}

TEST_F(JobLoopTest, FoldersOfWorkersThatWereKilledGo) {
  const JobLoop idle = loop("true");
  std::filesystem::create_directories(folder_ / "jobs" / "recald-job-999999999-abc" / "site");
  std::filesystem::create_directories(folder_ / "jobs" / "somebody-elses");
  EXPECT_EQ(run(idle), 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "jobs" / "recald-job-999999999-abc"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "jobs" / "somebody-elses"));
}

TEST(WorkFolder, WithoutAnOutcomeThereIsNoResult) {
  recald::testing::TemporaryFolder folder;
  recald::testing::write_text(folder / "job.json", "{}");
  EXPECT_FALSE(read_outcome(folder.path()));
  recald::testing::write_text(folder / "outcome.json", "no JSON");
  const auto damaged = read_outcome(folder.path());
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().code, ErrorCode::malformed);
}

}  // namespace
}  // namespace recald::daemon
