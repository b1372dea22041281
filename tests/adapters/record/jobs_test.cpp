#include "adapters/record/jobs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <thread>

#include "adapters/stores/open.hpp"
#include "tests/adapters/record/record_fixture.hpp"

namespace recald::record {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

/// A record whose sites have jobs.
class Jobs {
 public:
  explicit Jobs(postgres::Connection& connection) : connection_{connection} {}

  /// Closes months of a site, so that there is a job for each.
  void close(const std::string& site, const std::vector<unsigned>& months) {
    std::int64_t& number = sent_[site];
    RecordBatch batch{.outbox = 11, .after = {.entries = number}};
    for (const unsigned month : months) {
      for (const char* meter : {"steam", "power"}) {
        batch.entries.push_back(month_entry(++number, meter, month_of(2024, month), 1.0));
      }
    }
    const auto put = put_site(connection_, described(site), "ann");
    const auto taken = take(connection_, site, batch, kNow);
    if (!put || !taken) throw std::runtime_error("no jobs");
  }
  [[nodiscard]] std::optional<FleetJob> lease(const std::string& worker = "w1") {
    auto leased = record::lease(connection_, worker, rules);
    if (!leased) throw std::runtime_error(leased.error().message);
    return *leased;
  }
  [[nodiscard]] FleetJob newest() {
    auto found = jobs(connection_, "", 1);
    if (!found || found->empty()) throw std::runtime_error("no job");
    return found->at(0);
  }
  /// The clock of the leases is the database's, so time passes there.
  void let_leases_run_out() {
    (void)connection_.run_all("UPDATE job SET lease_until = now() - interval '1 second'");
  }
  void let_waits_end() {
    (void)connection_.run_all("UPDATE job SET not_before = now() - interval '1 second'");
  }

  LeaseRules rules;

 private:
  postgres::Connection& connection_;
  std::map<std::string, std::int64_t> sent_;
};

FleetResult result_of(const std::string& text) {
  return {.accepted = true,
          .message = "",
          .summary = "{\"of\":\"" + text + "\"}",
          .files = {{"calibration.json", text}, {"report.html", "<p>"}},
          .state = {{"versions.json", text}}};
}

TEST_F(Record, JobsOfASiteRunOneByOneInOrderOfTheirMonths) {
  Jobs jobs{*connection_};
  jobs.close("tower", {3, 4});
  jobs.close("annex", {3});
  const auto first = jobs.lease();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->site, "tower");
  EXPECT_EQ(first->month, month_of(2024, 3));
  EXPECT_EQ(first->state, FleetJobState::running);
  EXPECT_EQ(first->tries, 1);
  EXPECT_EQ(first->worker, "w1");
  const auto second = jobs.lease("w2");
  ASSERT_TRUE(second);
  EXPECT_EQ(second->site, "annex");
  EXPECT_EQ(jobs.lease("w3"), std::nullopt);
  ASSERT_TRUE(finish(*connection_, *first, result_of("march")).value());
  const auto third = jobs.lease("w3");
  ASSERT_TRUE(third);
  EXPECT_EQ(third->month, month_of(2024, 4));
  EXPECT_THAT(*job_counts(*connection_),
              UnorderedElementsAre(Pair(FleetJobState::running, 2), Pair(FleetJobState::done, 1)));
}

TEST_F(Record, AWorkerNeedsNoMoreThanItsRole) {
  Jobs{*connection_}.close("tower", {3, 4});
  const auto own = open_as("recald_worker", "plain_worker");
  Jobs jobs{*own};
  const auto march = jobs.lease();
  ASSERT_TRUE(march);
  EXPECT_TRUE(renew(*own, *march, jobs.rules).value());
  EXPECT_TRUE(state_before(*own, *march));
  EXPECT_TRUE(site_of_version(*own, "tower", march->site_version));
  const auto store = stores::open_in_memory();
  EXPECT_TRUE(copy_into(**store, *own, "tower", march->until_seq));
  auto result = result_of("march");
  result.next = JobKind::diagnosis;
  EXPECT_TRUE(finish(*own, *march, result).value());
  const auto next = jobs.lease();
  ASSERT_TRUE(next);
  EXPECT_TRUE(hand_back(*own, *next).value());
  const auto again = jobs.lease();
  ASSERT_TRUE(again);
  EXPECT_TRUE(fail(*own, *again, "no weather").value());
  const auto last = jobs.lease();
  ASSERT_TRUE(last);
  EXPECT_TRUE(give_back(*own, *last, "killed", jobs.rules).value());
  EXPECT_EQ(rerun(*own, {*march}, "ann").value(), 1);
  EXPECT_EQ(ask("SELECT who, role FROM audit WHERE action = 'rerun'"), "ann|plain_worker\n");
  for (const char* too_much :
       {"UPDATE result SET accepted = true", "DELETE FROM job", "UPDATE site SET version = 7",
        "DELETE FROM interval", "INSERT INTO site (id, version, added) VALUES ('x', 1, now())"}) {
    EXPECT_FALSE(own->run(too_much)) << too_much;
  }
  leave("plain_worker");
}

TEST_F(Record, AJobBeginsWithTheSameStateHoweverOftenItRuns) {
  Jobs jobs{*connection_};
  jobs.close("tower", {3, 4});
  const auto march = jobs.lease();
  ASSERT_TRUE(fail(*connection_, *march, "no weather").value());
  const auto april = jobs.lease();
  EXPECT_TRUE(state_before(*connection_, *april)->empty());
  ASSERT_TRUE(finish(*connection_, *april, result_of("april")).value());
  // March is mended later; April had begun without it.
  ASSERT_EQ(rerun(*connection_, {*march}, "ann"), 1);
  ASSERT_TRUE(finish(*connection_, *jobs.lease(), result_of("march")).value());
  ASSERT_EQ(rerun(*connection_, {*april}, "ann"), 1);
  const auto again = jobs.lease();
  ASSERT_EQ(again->number, april->number);
  EXPECT_TRUE(state_before(*connection_, *again)->empty());
}

TEST_F(Record, ASecondRunningJobOfASiteIsRefusedByTheTableItself) {
  Jobs jobs{*connection_};
  jobs.close("tower", {3, 4});
  ASSERT_TRUE(jobs.lease());
  EXPECT_THAT(ask("UPDATE job SET state = 'running'"), HasSubstr("job_running"));
}

TEST_F(Record, EachJobRunsExactlyOnceAmongManyWorkers) {
  Jobs jobs{*connection_};
  for (int site = 0; site < 50; ++site) jobs.close("s" + std::to_string(site), {2, 3, 4, 5});
  std::mutex mutex;
  std::map<std::int64_t, int> runs;
  std::map<std::string, std::vector<metering::Month>> order;
  std::vector<std::jthread> workers;
  for (int i = 0; i < 4; ++i) {
    workers.emplace_back([&, i, own = open()] {
      const std::string name = "w" + std::to_string(i);
      for (;;) {
        const auto job = lease(*own, name, {});
        ASSERT_TRUE(job) << job.error().message;
        const std::lock_guard lock{mutex};
        if (!*job && runs.size() == 200) return;
        if (!*job) continue;  // what waits is behind what others have
        ++runs[(*job)->number];
        order[(*job)->site].push_back((*job)->month);
        const auto done = finish(*own, **job, result_of((*job)->site));
        EXPECT_TRUE(done && *done);
      }
    });
  }
  workers.clear();
  EXPECT_EQ(runs.size(), 200u);
  for (const auto& [number, count] : runs) EXPECT_EQ(count, 1) << number;
  for (const auto& [site, months] : order) {
    EXPECT_THAT(months, ElementsAre(month_of(2024, 2), month_of(2024, 3), month_of(2024, 4),
                                    month_of(2024, 5)))
        << site;
  }
  EXPECT_EQ(ask("SELECT count(*), count(DISTINCT job) FROM result"), "200|200\n");
}

TEST_F(Record, TwoWorkersNeverLeaseTheSameJobAtOnce) {
  Jobs jobs{*connection_};
  for (int site = 0; site < 40; ++site) jobs.close("s" + std::to_string(site), {3, 4, 5, 6, 7});
  std::mutex mutex;
  std::multimap<std::string, std::int64_t> leased;
  std::vector<std::jthread> workers;
  for (int i = 0; i < 4; ++i) {
    workers.emplace_back([&, own = open()] {
      while (const auto job = lease(*own, "w", {}).value()) {
        const std::lock_guard lock{mutex};
        leased.emplace(job->site, job->number);
      }
    });
  }
  workers.clear();
  // Nobody finished any, so each site gave one.
  EXPECT_EQ(ask("SELECT count(*) FROM job WHERE state = 'running' AND tries = 1"),
            std::to_string(leased.size()) + "\n");
  for (const auto& [site, number] : leased) EXPECT_EQ(leased.count(site), 1u) << site;
  while (const auto job = jobs.lease()) leased.emplace(job->site, job->number);
  EXPECT_EQ(leased.size(), 40u);
}

TEST_F(Record, ALeaseThatRanOutIsATryThatFailed) {
  Jobs jobs{*connection_};
  jobs.close("tower", {3, 4});
  const auto first = jobs.lease("w1");
  ASSERT_TRUE(first);
  EXPECT_TRUE(renew(*connection_, *first, jobs.rules).value());
  EXPECT_EQ(jobs.lease("w2"), std::nullopt);
  jobs.let_leases_run_out();
  EXPECT_EQ(jobs.lease("w2"), std::nullopt);  // not before its wait is over, nor the next month
  EXPECT_FALSE(renew(*connection_, *first, jobs.rules).value());
  // 60 s after the first, 120 s after the second.
  EXPECT_EQ(ask("SELECT round(extract(epoch FROM not_before - lease_until)) FROM job "
                "WHERE tries = 1"),
            "60\n");
  jobs.let_waits_end();
  const auto second = jobs.lease("w2");
  ASSERT_TRUE(second);
  EXPECT_EQ(second->number, first->number);
  EXPECT_EQ(second->tries, 2);
  EXPECT_THAT(second->reason, HasSubstr("the lease of w1 ran out in try 1 of 3"));
  jobs.let_leases_run_out();
  EXPECT_EQ(jobs.lease("w3"), std::nullopt);
  EXPECT_EQ(ask("SELECT round(extract(epoch FROM not_before - lease_until)) FROM job "
                "WHERE tries = 2"),
            "120\n");
  jobs.let_waits_end();
  ASSERT_TRUE(jobs.lease("w3"));
  jobs.let_leases_run_out();
  // The third try was the last: it is set aside, and the next month of the site goes on.
  const auto next = jobs.lease("w4");
  ASSERT_TRUE(next);
  EXPECT_EQ(next->month, month_of(2024, 4));
  EXPECT_EQ(ask("SELECT state, reason FROM job WHERE tries = 3"),
            "set_aside|the lease of w3 ran out in try 3 of 3: it was ended or lost the record\n");
}

TEST_F(Record, WhoLostItsLeaseStoresNothing) {
  Jobs jobs{*connection_};
  jobs.close("tower", {3});
  const auto lost = jobs.lease("w1");
  jobs.let_leases_run_out();
  (void)jobs.lease("w2");
  jobs.let_waits_end();
  const auto owned = jobs.lease("w1");  // of the same name, but another try
  ASSERT_TRUE(lost && owned);
  auto late = result_of("late");
  late.next = JobKind::diagnosis;
  EXPECT_FALSE(finish(*connection_, *lost, late).value());
  EXPECT_FALSE(fail(*connection_, *lost, "late").value());
  EXPECT_FALSE(give_back(*connection_, *lost, "late", jobs.rules).value());
  EXPECT_FALSE(renew(*connection_, *lost, jobs.rules).value());
  EXPECT_EQ(ask("SELECT (SELECT count(*) FROM result), (SELECT count(*) FROM result_file), "
                "(SELECT count(*) FROM site_state), (SELECT count(*) FROM job)"),
            "0|0|0|1\n");
  EXPECT_TRUE(finish(*connection_, *owned, result_of("right")).value());
  EXPECT_FALSE(finish(*connection_, *owned, result_of("again")).value());
  EXPECT_EQ(*result_file(*connection_, "tower", JobKind::calibration, month_of(2024, 3),
                         "calibration.json"),
            "right");
}

TEST_F(Record, AResultIsStoredWithAllThatBelongsToIt) {
  Jobs jobs{*connection_};
  jobs.close("tower", {3});
  const auto job = jobs.lease();
  ASSERT_TRUE(job);
  EXPECT_TRUE(state_before(*connection_, *job)->empty());
  auto result = result_of("march");
  result.files["bytes"] = std::string{"\0\xff\\'", 4};
  result.named = true;
  result.message = "fits";
  result.next = JobKind::diagnosis;
  result.next_asked_by = "drift";

  // If any part of it cannot be stored, none is.
  (void)ask("ALTER TABLE site_state ADD CONSTRAINT none CHECK (name = '')");
  EXPECT_FALSE(finish(*connection_, *job, result));
  EXPECT_EQ(ask("SELECT (SELECT count(*) FROM result), (SELECT count(*) FROM job WHERE state = "
                "'running'), (SELECT count(*) FROM job)"),
            "0|1|1\n");
  (void)ask("ALTER TABLE site_state DROP CONSTRAINT none");
  ASSERT_TRUE(finish(*connection_, *job, result).value());

  const auto found = newest_results(*connection_, JobKind::calibration);
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->size(), 1u);
  EXPECT_EQ(found->at(0).from, "worker");
  EXPECT_EQ(found->at(0).month, month_of(2024, 3));
  EXPECT_TRUE(found->at(0).accepted);
  EXPECT_TRUE(found->at(0).named);
  EXPECT_EQ(found->at(0).message, "fits");
  EXPECT_EQ(found->at(0).summary, "{\"of\":\"march\"}");
  EXPECT_EQ(found->at(0).input_sha256, job->input_sha256);
  EXPECT_EQ(found->at(0).sha256.size(), 64u);
  EXPECT_THAT(found->at(0).files, ElementsAre("bytes", "calibration.json", "report.html"));
  EXPECT_EQ(*result_file(*connection_, "tower", JobKind::calibration, month_of(2024, 3), "bytes"),
            result.files["bytes"]);
  EXPECT_EQ(result_file(*connection_, "tower", JobKind::calibration, month_of(2024, 3), "none")
                .error()
                .code,
            ErrorCode::not_found);

  const auto next = jobs.lease();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->kind, JobKind::diagnosis);
  EXPECT_EQ(next->asked_by, "drift");
  EXPECT_EQ(next->month, job->month);
  EXPECT_EQ(next->until_seq, job->until_seq);
  EXPECT_EQ(next->now, job->now);
  EXPECT_NE(next->input_sha256, job->input_sha256);
  EXPECT_THAT(*state_before(*connection_, *next), ElementsAre(Pair("versions.json", "march")));
}

// A job begins with the same state whenever it runs, so it gives the same bytes.
TEST_F(Record, TheStateBeforeAJobIsThatOfItsPlaceInTheOrder) {
  Jobs jobs{*connection_};
  jobs.close("tower", {3, 4, 5});
  for (const char* text : {"march", "april", "may"}) {
    const auto job = jobs.lease();
    ASSERT_TRUE(job);
    ASSERT_TRUE(finish(*connection_, *job, result_of(text)).value());
  }
  const auto april = would_rerun(*connection_, {.month = month_of(2024, 4)});
  ASSERT_TRUE(april) << april.error().message;
  ASSERT_EQ(rerun(*connection_, *april, "ann").value(), 1);
  const auto again = jobs.lease();
  ASSERT_TRUE(again);
  EXPECT_EQ(again->number, april->at(0).number);
  EXPECT_THAT(*state_before(*connection_, *again), ElementsAre(Pair("versions.json", "march")));
  ASSERT_TRUE(finish(*connection_, *again, result_of("april 2")).value());
  // The newest month is still May's.
  EXPECT_EQ(newest_results(*connection_, JobKind::calibration)->at(0).month, month_of(2024, 5));
  EXPECT_EQ(*result_file(*connection_, "tower", JobKind::calibration, month_of(2024, 4),
                         "calibration.json"),
            "april 2");
}

TEST_F(Record, AJobThatCannotSucceedFailsAtOnce) {
  Jobs jobs{*connection_};
  jobs.close("tower", {3, 4});
  const auto job = jobs.lease();
  ASSERT_TRUE(fail(*connection_, *job, "not enough months").value());
  const auto next = jobs.lease();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->month, month_of(2024, 4));
  const auto found = record::jobs(*connection_, "tower", 2);
  EXPECT_EQ(found->at(1).state, FleetJobState::failed);
  EXPECT_EQ(found->at(1).reason, "not enough months");
}

TEST_F(Record, TroubleIsThatOfTheNewestJobOfAKind) {
  Jobs jobs{*connection_};
  jobs.close("tower", {3, 4});
  ASSERT_TRUE(fail(*connection_, *jobs.lease(), "there are 3 months").value());
  // The next one waits, and may go well.
  EXPECT_THAT(*troubled_jobs(*connection_), IsEmpty());
  ASSERT_TRUE(fail(*connection_, *jobs.lease(), "there are 4 months").value());
  const auto troubled = troubled_jobs(*connection_);
  ASSERT_TRUE(troubled) << troubled.error().message;
  ASSERT_EQ(troubled->size(), 1u);
  EXPECT_EQ(troubled->at(0).site, "tower");
  EXPECT_EQ(troubled->at(0).reason, "there are 4 months");
  jobs.close("tower", {5});
  ASSERT_TRUE(finish(*connection_, *jobs.lease(), result_of("may")).value());
  EXPECT_THAT(*troubled_jobs(*connection_), IsEmpty());
}

TEST_F(Record, AJobThatIsGivenBackWaitsLongerEachTimeAndIsSetAside) {
  Jobs jobs{*connection_};
  jobs.close("tower", {3});
  jobs.close("annex", {3});
  for (const char* wait : {"60\n", "120\n", "set_aside\n"}) {
    const auto job = jobs.lease();
    ASSERT_TRUE(job);
    EXPECT_EQ(job->site, "tower");
    ASSERT_TRUE(give_back(*connection_, *job, "out of memory", jobs.rules).value());
    EXPECT_EQ(ask("SELECT CASE state WHEN 'waiting' THEN "
                  "round(extract(epoch FROM not_before - now()) / 60) * 60 || '' ELSE state END "
                  "FROM job WHERE tries > 0"),
              wait);
    jobs.let_waits_end();
  }
  EXPECT_EQ(jobs.lease()->site, "annex");
  EXPECT_EQ(record::jobs(*connection_, "tower", 1)->at(0).reason, "out of memory");
}

TEST_F(Record, SitesThatAreRetiredHaveNoJobs) {
  Jobs jobs{*connection_};
  jobs.close("tower", {3});
  ASSERT_TRUE(retire_site(*connection_, "tower", "ann"));
  EXPECT_EQ(jobs.lease(), std::nullopt);
}

TEST_F(Record, RerunIsSeenBeforeItIsDone) {
  Jobs jobs{*connection_};
  jobs.close("tower", {3, 4});
  jobs.close("annex", {3});
  for (int i = 0; i < 3; ++i) {
    const auto job = jobs.lease();
    ASSERT_TRUE(job);
    if (job->site == "annex") {
      ASSERT_TRUE(fail(*connection_, *job, "no weather").value());
    } else {
      ASSERT_TRUE(finish(*connection_, *job, result_of("1")).value());
    }
  }
  const auto all = would_rerun(*connection_, {});
  ASSERT_TRUE(all) << all.error().message;
  ASSERT_EQ(all->size(), 2u);  // the last month of each
  EXPECT_EQ(all->at(0).site, "annex");
  EXPECT_EQ(all->at(1).site, "tower");
  EXPECT_EQ(all->at(1).month, month_of(2024, 4));
  EXPECT_EQ(would_rerun(*connection_, {.month = month_of(2024, 3)})->size(), 2u);
  EXPECT_EQ(would_rerun(*connection_, {.sites = {"tower"}})->size(), 1u);
  EXPECT_EQ(would_rerun(*connection_, {.state = FleetJobState::failed})->at(0).site, "annex");
  EXPECT_TRUE(would_rerun(*connection_, {.kind = JobKind::diagnosis})->empty());
  EXPECT_EQ(jobs.lease(), std::nullopt);  // nothing was changed

  // With the same description it is the same job; with another it is another one.
  auto site = described("annex");
  site.files["weather/city.epw"] = "now there";
  ASSERT_TRUE(put_site(*connection_, site, "bob"));
  const auto seen = would_rerun(*connection_, {});
  ASSERT_EQ(rerun(*connection_, *seen, "bob").value(), 2);
  EXPECT_EQ(rerun(*connection_, *seen, "bob").value(), 0);  // they wait already
  EXPECT_EQ(ask("SELECT count(*) FROM job"), "4\n");
  std::map<std::string, FleetJob> leased;
  while (const auto job = jobs.lease()) leased[job->site] = *job;
  ASSERT_EQ(leased.size(), 2u);
  EXPECT_EQ(leased["tower"].number, all->at(1).number);
  EXPECT_EQ(leased["tower"].tries, 1);
  EXPECT_EQ(leased["annex"].site_version, 2);
  EXPECT_EQ(leased["annex"].input_sha256, seen->at(0).input_sha256);
  EXPECT_NE(leased["annex"].number, all->at(0).number);
  EXPECT_EQ(leased["annex"].asked_by, "rerun");
  EXPECT_EQ(ask("SELECT who, subject, text FROM audit WHERE action = 'rerun' ORDER BY number "
                "LIMIT 2"),
            "bob|annex|calibration of 2024-03\nbob|tower|calibration of 2024-04\n");
}

TEST_F(Record, TheSameInputHasOneJob) {
  Jobs jobs{*connection_};
  jobs.close("tower", {3});
  EXPECT_THAT(ask("INSERT INTO job (site, version, kind, month, until_seq, now, input_sha256, "
                  "asked_by) SELECT site, version, kind, month, until_seq, now, input_sha256, 'me' "
                  "FROM job"),
              HasSubstr("duplicate key"));
  EXPECT_EQ(jobs.newest().input_sha256.size(), 64u);
}

}  // namespace
}  // namespace recald::record
