#include "daemon/gateway/ingest/open_month.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace recald::daemon::open_month_test {
namespace {

using metering::Instant;
using metering::Validity;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;

class OpenMonthTest : public ::testing::Test {
 protected:
  void measure(Instant from, Instant to, Validity validity = Validity::ok) {
    for (Instant t = from; t < to; t += minutes{15}) month_.observe({0, t, 1.0, validity});
  }
  metering::LocalCalendar calendar_ = metering::LocalCalendar::open("America/Chicago").value();
  /// 744 hours but one: the clocks go forward.
  metering::TimeSpan march_ = calendar_.month_span(std::chrono::year{2024} / 3);
  OpenMonth month_{calendar_, minutes{15}};
};

TEST_F(OpenMonthTest, IsTheShareOfWhatHasEnded) {
  measure(march_.begin, march_.begin + hours{3});
  EXPECT_EQ(month_.coverage(march_.begin + hours{3}), 1.0);
  EXPECT_EQ(month_.coverage(march_.begin + hours{4} + minutes{1}), 0.75);
  EXPECT_EQ(month_.coverage(march_.begin + hours{3} + minutes{15}), 1.0);  // not booked yet
}

TEST_F(OpenMonthTest, OnlyWhatIsMeasuredCounts) {
  measure(march_.begin, march_.begin + hours{1});
  measure(march_.begin + hours{1}, march_.begin + hours{2}, Validity::scaled);
  EXPECT_EQ(month_.coverage(march_.begin + hours{2} + minutes{1}), 0.5);
}

TEST_F(OpenMonthTest, AMeasuredIntervalStays) {
  measure(march_.begin, march_.begin + hours{1}, Validity::missing);
  measure(march_.begin, march_.begin + hours{1});
  measure(march_.begin, march_.begin + hours{1},
          Validity::scaled);  // the store kept the better one
  EXPECT_EQ(month_.coverage(march_.begin + hours{1} + minutes{1}), 1.0);
}

TEST_F(OpenMonthTest, AWholeMonthWithItsClockChange) {
  measure(march_.begin, march_.end);
  EXPECT_EQ(march_.length(), hours{743});
  EXPECT_EQ(month_.coverage(march_.end - seconds{1}), 1.0);
}

TEST_F(OpenMonthTest, ANewMonthBeginsWithNothing) {
  measure(march_.begin, march_.end);
  EXPECT_TRUE(std::isnan(month_.coverage(march_.end)));
  EXPECT_EQ(month_.coverage(march_.end + hours{1}), 0.0);
  measure(march_.end, march_.end + hours{1});
  EXPECT_EQ(month_.coverage(march_.end + hours{1} + minutes{1}), 1.0);
  measure(march_.begin, march_.end);  // late readings of the month before
  EXPECT_EQ(month_.coverage(march_.end + hours{2} + minutes{1}), 0.5);
}

}  // namespace
}  // namespace recald::daemon::open_month_test
