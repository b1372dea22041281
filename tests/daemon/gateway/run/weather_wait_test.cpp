#include "daemon/gateway/run/weather_wait.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "adapters/results/job_result_json.hpp"
#include "adapters/sqlite/sqlite_store.hpp"
#include "tests/support/virtual_loop.hpp"
#include "tests/support/virtual_worker.hpp"

namespace recald::daemon::weather_wait_test {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class WeatherWaitTest : public ::testing::Test {
 protected:
  /// A calibration that ended, with how much it knew of the weather of March.
  void calibrated(double known, JobState state = JobState::done) {
    StoredJob job{.kind = JobKind::calibration, .state = state};
    job.result.document = R"({"weather":[{"month":"2026-02","known":1.0,"from":{}},
        {"month":"2026-03","known":)" +
                          std::to_string(known) + R"(,"from":{"weather.csv":0.3}}]})";
    ASSERT_TRUE(store_.add_job(job).has_value());
  }
  void begin() {
    wait_ = std::make_unique<WeatherWait>(
        WeatherWait::Ports{loop_, store_, worker_},
        [this](const metering::MonthRange& months) { return look(months); }, [this] { ++asked_; });
    wait_->start();
  }
  Result<std::vector<MonthWeather>> look(const metering::MonthRange& months) {
    looked_.push_back(metering::to_string(months.first) + " " + metering::to_string(months.last));
    if (is_broken_) throw std::runtime_error("unforeseen");
    return std::vector<MonthWeather>{{.month = "2026-03", .known = known_}};
  }

  recald::testing::VirtualLoop loop_{std::chrono::sys_days{std::chrono::year{2026} / 4 / 4}};
  recald::testing::VirtualWorker worker_{loop_, minutes{2}};
  sqlite::SqliteStore store_ = sqlite::SqliteStore::open(":memory:").value();
  std::unique_ptr<WeatherWait> wait_;
  std::vector<std::string> looked_;
  double known_ = 0.3;
  bool is_broken_ = false;
  int asked_ = 0;
};

TEST_F(WeatherWaitTest, WhoLacksNothingDoesNotLook) {
  begin();
  loop_.run_for(hours{5});
  EXPECT_THAT(looked_, IsEmpty());  // nobody has calibrated yet
  calibrated(0.95);
  loop_.run_for(hours{5});
  EXPECT_THAT(looked_, IsEmpty());
  EXPECT_EQ(asked_, 0);
}

TEST_F(WeatherWaitTest, TheMonthThatLackedItIsAReasonWhenItHasCome) {
  calibrated(0.3);
  begin();
  loop_.run_for(minutes{3});
  EXPECT_THAT(looked_, ElementsAre("2026-02 2026-03"));  // as the calibration
  known_ = 0.49;
  loop_.run_for(hours{2});
  EXPECT_EQ(asked_, 0);  // still mostly invented
  known_ = 0.55;
  loop_.run_for(hours{1});
  EXPECT_EQ(asked_, 1);
  calibrated(0.55);
  known_ = 0.8;
  loop_.run_for(hours{3});
  EXPECT_EQ(asked_, 1);
  known_ = 1.0;
  loop_.run_for(hours{1});
  EXPECT_EQ(asked_, 2);
  calibrated(1.0);
  loop_.run_for(hours{5});
  EXPECT_EQ(asked_, 2);
}

TEST_F(WeatherWaitTest, OneThatFailedForWantOfItIsMadeAgain) {
  calibrated(0.0, JobState::failed);
  begin();
  loop_.run_for(hours{1});
  EXPECT_EQ(asked_, 0);
  known_ = 0.6;
  loop_.run_for(hours{1});
  EXPECT_EQ(asked_, 1);
}

TEST_F(WeatherWaitTest, WhatWaitsOrRunsWillSeeIt) {
  calibrated(0.3);
  known_ = 1.0;
  ASSERT_TRUE(store_.add_job({.kind = JobKind::calibration, .state = JobState::running}));
  begin();
  loop_.run_for(hours{4});
  EXPECT_THAT(looked_, IsEmpty());
  EXPECT_EQ(asked_, 0);
}

TEST_F(WeatherWaitTest, ALookThatThrowsIsMadeAgain) {
  calibrated(0.3);
  known_ = 1.0;
  is_broken_ = true;
  begin();
  loop_.run_for(hours{2} + minutes{5});
  EXPECT_EQ(looked_.size(), 3U);
  is_broken_ = false;
  loop_.run_for(hours{1});
  EXPECT_EQ(asked_, 1);
}

TEST_F(WeatherWaitTest, OneLookAtATime) {
  calibrated(0.3);
  recald::testing::VirtualWorker slow{loop_, hours{3}};
  WeatherWait wait{{loop_, store_, slow},
                   [this](const metering::MonthRange& months) { return look(months); },
                   [this] { ++asked_; }};
  wait.start();
  loop_.run_for(hours{5} + minutes{30});
  EXPECT_EQ(looked_.size(), 1U);  // the next one began after three hours; two more were due before
}

TEST_F(WeatherWaitTest, OneThatWasCancelledOrFailedOtherwiseEndsNoWaiting) {
  calibrated(0.3);
  ASSERT_TRUE(store_.add_job({.kind = JobKind::calibration, .state = JobState::failed}));
  ASSERT_TRUE(store_.add_job({.kind = JobKind::calibration, .state = JobState::cancelled}));
  begin();
  loop_.run_for(hours{1} + minutes{5});
  EXPECT_EQ(looked_.size(), 2U);
  EXPECT_EQ(asked_, 0);
  known_ = 1.0;
  loop_.run_for(hours{1});
  EXPECT_EQ(asked_, 1);
  // What was asked for fails, for whatever reason: the same weather is no reason to ask again.
  ASSERT_TRUE(store_.add_job({.kind = JobKind::calibration, .state = JobState::failed}));
  loop_.run_for(hours{50});
  EXPECT_EQ(asked_, 1);
}

TEST_F(WeatherWaitTest, WhatIsAskedForWithPatchyWeatherIsAskedForOnceMoreWithGood) {
  calibrated(0.3);
  known_ = 0.6;
  begin();
  loop_.run_for(hours{1});
  EXPECT_EQ(asked_, 1);
  ASSERT_TRUE(store_.add_job({.kind = JobKind::calibration, .state = JobState::failed}));
  loop_.run_for(hours{5});
  EXPECT_EQ(asked_, 1);
  known_ = 1.0;
  loop_.run_for(hours{5});
  EXPECT_EQ(asked_, 2);
}

// What has not come for two months is looked for once a day.
TEST_F(WeatherWaitTest, AnOldHoleCostsALookADay) {
  calibrated(0.3);
  begin();
  loop_.run_for(hours{24 * 56} - minutes{30});  // until the end of May
  EXPECT_EQ(looked_.size(), 24U * 56U);
  loop_.run_for(hours{24 * 2});
  looked_.clear();
  loop_.run_for(hours{24 * 10});
  EXPECT_EQ(looked_.size(), 10U);
  wait_->set_check([this](const metering::MonthRange& months) { return look(months); });
  loop_.run_for(hours{1});
  EXPECT_EQ(looked_.size(), 11U);
}

}  // namespace
}  // namespace recald::daemon::weather_wait_test
