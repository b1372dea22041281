#include "daemon/gateway/run/load_watch.hpp"

#include <gmock/gmock.h>

#include "tests/support/virtual_loop.hpp"
#include "tests/support/virtual_worker.hpp"

namespace recald::daemon::load_watch_test {
namespace {

using metering::Instant;
using recald::testing::VirtualLoop;
using recald::testing::VirtualWorker;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::SizeIs;

const Instant kStart =
    std::chrono::sys_days{std::chrono::year{2026} / 2 / 3} + hours{12} + minutes{20};

class LoadWatchTest : public ::testing::Test {
 protected:
  ExpectLoads expect_of(const std::string& meter) {
    return [this, meter](const metering::TimeSpan& span) -> Result<std::vector<ExpectedMeter>> {
      asked_.push_back(span);
      if (fails_) return failure(ErrorCode::not_enough_data, "no weather");
      return std::vector<ExpectedMeter>{{meter, {}}};
    };
  }
  [[nodiscard]] std::string latest() const {
    return watch_.latest().empty() ? "" : watch_.latest().front().meter;
  }

  VirtualLoop loop_{kStart};
  VirtualWorker worker_{loop_, seconds{10}};
  std::vector<metering::TimeSpan> asked_;
  bool is_busy_ = false;
  bool fails_ = false;
  LoadWatch watch_{loop_, worker_, expect_of("main"), [this] { return is_busy_; }};
};

TEST_F(LoadWatchTest, AsksOnceAnHourForEightDaysOnTheHour) {
  watch_.start();
  EXPECT_EQ(latest(), "");
  loop_.run_for(seconds{11});
  EXPECT_EQ(latest(), "main");
  EXPECT_EQ(asked_.at(0).begin, kStart - minutes{20} - days{8});
  loop_.run_for(hours{5});
  EXPECT_THAT(asked_, SizeIs(6));
  fails_ = true;
  loop_.run_for(hours{1});
  EXPECT_EQ(latest(), "");  // what is not known any more is not shown
}

TEST_F(LoadWatchTest, WaitsForAJobToEnd) {
  is_busy_ = true;
  watch_.start();
  loop_.run_for(minutes{30});
  EXPECT_THAT(asked_, SizeIs(0));
  is_busy_ = false;
  loop_.run_for(minutes{2});
  EXPECT_THAT(asked_, SizeIs(1));
}

TEST_F(LoadWatchTest, AnAnswerForAnEarlierSiteFileIsDropped) {
  watch_.start();
  loop_.run_for(seconds{5});  // it is being asked
  watch_.set_expect(expect_of("another"));
  loop_.run_for(seconds{6});
  EXPECT_EQ(latest(), "");
  loop_.run_for(minutes{2});
  EXPECT_EQ(latest(), "another");
}

}  // namespace
}  // namespace recald::daemon::load_watch_test
