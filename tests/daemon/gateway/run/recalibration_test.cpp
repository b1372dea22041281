#include "daemon/gateway/run/recalibration.hpp"

#include <gmock/gmock.h>

#include "adapters/sqlite/sqlite_store.hpp"
#include "tests/support/virtual_loop.hpp"

namespace recald::daemon::recalibration_test {
namespace {

using recald::testing::VirtualLoop;
using std::chrono::hours;
using std::chrono::minutes;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class RecalibrationTest : public ::testing::Test {
 protected:
  RecalibrationTest() {
    site_.model = ModelConfig{.kind = ModelKind::epc, .outputs = {"main", "steam"}};
  }
  void begin(const char* schedule) {
    site_.recalibration.schedule = parse_schedule(schedule).value();
    recalibration_ = std::make_unique<Recalibration>(
        loop_, site_, metering::LocalCalendar::open("Europe/Berlin").value(),
        [this](const std::string& asked_by) {
          asked_.push_back(asked_by + " " + metering::to_string(loop_.now().instant()));
        });
    recalibration_->start();
  }

  VirtualLoop loop_{std::chrono::sys_days{std::chrono::year{2026} / 3 / 28}};
  SiteConfig site_;
  std::vector<std::string> asked_;
  std::unique_ptr<Recalibration> recalibration_;
};

TEST_F(RecalibrationTest, MonthsThatCloseTogetherAreOneReason) {
  begin("monthly");
  recalibration_->month_closed("main");
  recalibration_->month_closed("steam");
  EXPECT_THAT(asked_, IsEmpty());  // not before both are stored
  loop_.run_for(minutes{1});
  EXPECT_THAT(asked_, ElementsAre("month 2026-03-28T00:01:00Z"));
  recalibration_->month_closed("steam");
  loop_.run_for(minutes{1});
  EXPECT_EQ(asked_.size(), 2U);
}

// Killed between a month and the calibration that it is a reason for.
TEST_F(RecalibrationTest, AMonthThatNobodyHeardOfIsAReasonAtTheNextStart) {
  auto store = sqlite::SqliteStore::open(":memory:").value();
  const auto add_meter = [&](const char* id) {
    site_.meters.push_back(
        {.meter = {.id = id, .interval = minutes{15}}, .source = MeterSource::http});
    return store.meter_number(id, minutes{15}).value();
  };
  const auto close = [&](std::uint32_t meter, unsigned month) {
    metering::MonthlyFigure figure;
    figure.month = std::chrono::year{2026} / std::chrono::month{month};
    ASSERT_TRUE(store.put_month(meter, figure, "2025b", loop_.now().instant()).has_value());
  };
  const auto main = add_meter("main");
  const auto steam = add_meter("steam");
  site_.closing.watermark = hours{72};
  begin("monthly");
  const auto asks = [&] {
    EXPECT_TRUE(recalibration_->catch_up(store, site_).has_value());
    return !std::exchange(asked_, {}).empty();
  };
  EXPECT_FALSE(asks());  // nothing has closed
  close(main, 2);
  EXPECT_FALSE(asks());  // not for both
  close(steam, 2);
  EXPECT_TRUE(asks());
  const metering::Instant closed =
      std::chrono::sys_days{std::chrono::year{2026} / 3 / 1} + hours{71};
  (void)store.add_job({.kind = JobKind::calibration, .asked = closed - minutes{1}});
  EXPECT_TRUE(asks());  // that one could not know the month
  (void)store.add_job({.kind = JobKind::calibration, .asked = closed});
  EXPECT_FALSE(asks());
  begin("never");
  close(main, 3);
  close(steam, 3);
  EXPECT_FALSE(asks());
}

TEST_F(RecalibrationTest, MetersThatAreNotModelledAreNoReason) {
  begin("monthly");
  recalibration_->month_closed("lift");
  loop_.run_for(minutes{1});
  EXPECT_THAT(asked_, IsEmpty());
}

TEST_F(RecalibrationTest, AMonthOfAPartOfAModelledSumIsAReason) {
  for (const char* id : {"east", "west"}) {
    site_.meters.push_back({.meter = {.id = id}, .source = MeterSource::http});
  }
  site_.meters.push_back({.meter = {.id = "main"},
                          .source = MeterSource::sum,
                          .sum_of = {{"east", 1.0}, {"west", 1.0}}});
  begin("monthly");
  recalibration_->month_closed("east");
  loop_.run_for(minutes{1});
  EXPECT_THAT(asked_, ElementsAre("month 2026-03-28T00:01:00Z"));
}

TEST_F(RecalibrationTest, NeverMeansNever) {
  begin("never");
  recalibration_->month_closed("main");
  loop_.run_for(hours{24 * 400});
  EXPECT_THAT(asked_, IsEmpty());
}

TEST_F(RecalibrationTest, WithoutAModelThereIsNothingToCalibrate) {
  site_.model.reset();
  begin("monthly");
  recalibration_->month_closed("main");
  loop_.run_for(minutes{1});
  EXPECT_THAT(asked_, IsEmpty());
}

// Berlin goes to summer time on the 29th.
TEST_F(RecalibrationTest, TheScheduleFollowsTheLocalClock) {
  begin("30 3 * * *");
  recalibration_->month_closed("main");
  loop_.run_for(hours{72});
  EXPECT_THAT(asked_, ElementsAre("schedule 2026-03-28T02:30:00Z", "schedule 2026-03-29T01:30:00Z",
                                  "schedule 2026-03-30T01:30:00Z"));
}

TEST_F(RecalibrationTest, AClockThatWasDecadesAheadMissesNoTime) {
  for (const auto ahead : {std::chrono::years{54}, std::chrono::years{80}}) {
    SCOPED_TRACE(ahead.count());
    asked_.clear();
    loop_.set_wall_clock(ahead);
    begin("0 3 * * *");
    loop_.run_for(minutes{10});
    asked_.clear();
    loop_.set_wall_clock(-ahead);
    loop_.run_for(hours{24});
    EXPECT_EQ(asked_.size(), 1U);
  }
}

TEST_F(RecalibrationTest, AClockThatIsSetMovesTheNextTime) {
  begin("0 12 * * *");
  loop_.run_for(hours{1});
  loop_.set_wall_clock(hours{5});
  loop_.run_for(hours{6});
  ASSERT_EQ(asked_.size(), 1U);
  EXPECT_EQ(asked_[0], "schedule 2026-03-28T11:00:00Z");
}

}  // namespace
}  // namespace recald::daemon::recalibration_test
