/// Clock changes of an export against those of the zone that it is read in.
#include "daemon/site/replay/clock_doubts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace recald::daemon::clock_doubts_test {
namespace {

using metering::Day;
using metering::Instant;
using metering::LocalCalendar;
using std::chrono::hours;
using std::chrono::minutes;
using ::testing::Contains;
using ::testing::HasSubstr;

LocalCalendar calendar(const std::string& zone) { return LocalCalendar::open(zone).value(); }

table::ClockFacts put_back_at(const char* day, minutes time) {
  table::ClockFacts facts;
  const Day date = metering::parse_day(day).value();
  facts.put_back[date] = Instant{std::chrono::sys_days{date}} + time;
  return facts;
}

TEST(ClockDoubts, ItsOwnChangesAreNone) {
  EXPECT_FALSE(other_clock({}, calendar("Europe/Berlin")));
  for (const auto& [zone, day, hour] :
       {std::tuple{"Europe/Berlin", "2023-10-29", 2}, std::tuple{"Europe/London", "2023-10-29", 1},
        std::tuple{"America/Denver", "2023-11-05", 1},
        std::tuple{"Australia/Sydney", "2023-04-02", 2}}) {
    // Labels of starts, of ends, and of loggers that are some seconds early.
    for (const minutes time : {hours{hour} + minutes{0}, hours{hour} + minutes{45},
                               hours{hour + 1} + minutes{0}, hours{hour} - minutes{1}}) {
      EXPECT_FALSE(other_clock(put_back_at(day, time), calendar(zone))) << zone << time.count();
    }
  }
}

TEST(ClockDoubts, ChangesOfOtherCountriesAreNamed) {
  const auto american = other_clock(put_back_at("2023-11-05", hours{1}), calendar("Europe/Berlin"));
  ASSERT_TRUE(american);
  EXPECT_THAT(american->zones, Contains("America/New_York"));
  EXPECT_THAT(american->because, HasSubstr("2023-11-05 its clock shows 01:00 twice"));
  const auto british = other_clock(put_back_at("2023-10-29", hours{1}), calendar("Europe/Berlin"));
  ASSERT_TRUE(british);
  EXPECT_THAT(british->zones, Contains("Europe/London"));
  // Whoever has no summer time is asked too.
  EXPECT_TRUE(other_clock(put_back_at("2023-10-29", hours{2}), calendar("Asia/Dubai")));
}

// Rows that come twice, on days on which no clock changes.
TEST(ClockDoubts, RowsThatComeTwiceAreNoClock) {
  for (const char* day : {"2023-05-05", "2023-07-31", "2023-12-24"}) {
    EXPECT_FALSE(other_clock(put_back_at(day, hours{1}), calendar("Europe/Berlin"))) << day;
  }
  auto both = put_back_at("2023-11-05", hours{1});
  both.put_back.merge(put_back_at("2023-12-24", hours{1}).put_back);
  EXPECT_FALSE(other_clock(both, calendar("Europe/Berlin")));
}

}  // namespace
}  // namespace recald::daemon::clock_doubts_test
