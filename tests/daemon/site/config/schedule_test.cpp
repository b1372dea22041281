#include "daemon/site/config/service/schedule.hpp"

#include <gmock/gmock.h>

namespace recald::daemon::schedule_test {
namespace {

using metering::Instant;
using ::testing::HasSubstr;

metering::LocalCalendar calendar(const char* zone = "Europe/Berlin") {
  return metering::LocalCalendar::open(zone).value();
}

Instant utc(int year, unsigned month, unsigned day, int hour, int minute) {
  return std::chrono::sys_days{std::chrono::year{year} / month / day} + std::chrono::hours{hour} +
         std::chrono::minutes{minute};
}

std::string next(const char* text, Instant after, const char* zone = "Europe/Berlin") {
  const auto schedule = parse_schedule(text);
  EXPECT_TRUE(schedule.has_value()) << schedule.error().message;
  const auto at = schedule->times->next(after, calendar(zone));
  return at ? metering::to_string(*at) : "never";
}

TEST(Schedule, MonthlyWaitsForMonthsAndNeverForNothing) {
  const auto monthly = parse_schedule("monthly");
  ASSERT_TRUE(monthly.has_value());
  EXPECT_TRUE(monthly->when_a_month_closes);
  EXPECT_FALSE(monthly->times.has_value());
  const auto never = parse_schedule("never");
  ASSERT_TRUE(never.has_value());
  EXPECT_FALSE(never->when_a_month_closes);
  EXPECT_FALSE(never->times.has_value());
}

TEST(Schedule, TimesAreLocal) {
  EXPECT_EQ(next("30 3 * * *", utc(2026, 1, 10, 0, 0)), "2026-01-10T02:30:00Z");
  EXPECT_EQ(next("30 3 * * *", utc(2026, 7, 10, 0, 0)), "2026-07-10T01:30:00Z");
}

TEST(Schedule, TheTimeItselfIsOver) {
  EXPECT_EQ(next("30 3 * * *", utc(2026, 1, 10, 2, 30)), "2026-01-11T02:30:00Z");
  EXPECT_EQ(next("30 3 * * *", utc(2026, 1, 10, 2, 30) - std::chrono::seconds{1}),
            "2026-01-10T02:30:00Z");
}

TEST(Schedule, StepsRangesAndLists) {
  EXPECT_EQ(next("*/20 * * * *", utc(2026, 1, 10, 5, 20)), "2026-01-10T05:40:00Z");
  EXPECT_EQ(next("0 8-10 * * *", utc(2026, 1, 10, 9, 0)), "2026-01-11T07:00:00Z");
  EXPECT_EQ(next("0 0 1,15 * *", utc(2026, 1, 2, 0, 0)), "2026-01-14T23:00:00Z");
  EXPECT_EQ(next("5 0 1 1-12/6 *", utc(2026, 2, 1, 0, 0)), "2026-06-30T22:05:00Z");
}

// As cron has it: with both given, either will do.
TEST(Schedule, DaysOfMonthAndWeek) {
  EXPECT_EQ(next("0 12 * * 1", utc(2026, 1, 10, 0, 0)), "2026-01-12T11:00:00Z");
  EXPECT_EQ(next("0 12 11 * 1", utc(2026, 1, 10, 0, 0)), "2026-01-11T11:00:00Z");
  EXPECT_EQ(next("0 12 * * 7", utc(2026, 1, 10, 0, 0)), "2026-01-11T11:00:00Z");
  EXPECT_EQ(next("0 12 * * 0", utc(2026, 1, 10, 0, 0)), "2026-01-11T11:00:00Z");
}

TEST(Schedule, ATimeThatTheClockJumpsOverComesAtTheJump) {
  EXPECT_EQ(next("30 2 29 3 *", utc(2026, 3, 1, 0, 0)), "2026-03-29T01:00:00Z");
}

TEST(Schedule, ATimeThatOccursTwiceComesOnce) {
  EXPECT_EQ(next("30 2 25 10 *", utc(2026, 10, 1, 0, 0)), "2026-10-25T00:30:00Z");
  EXPECT_EQ(next("30 2 25 10 *", utc(2026, 10, 25, 0, 30)), "2027-10-25T00:30:00Z");
}

TEST(Schedule, LeapDaysComeAndThe30thOfFebruaryDoesNot) {
  EXPECT_EQ(next("0 0 29 2 *", utc(2025, 3, 1, 0, 0), "UTC"), "2028-02-29T00:00:00Z");
  EXPECT_EQ(next("0 0 30 2 *", utc(2025, 3, 1, 0, 0), "UTC"), "never");
}

TEST(Schedule, WhatIsNotUnderstoodIsNamed) {
  const auto message = [](const char* text) {
    const auto schedule = parse_schedule(text);
    return schedule ? std::string{"understood"} : schedule.error().message;
  };
  for (const char* text : {"", "weekly", "0 0 * *", "0 0 * * * *"}) {
    EXPECT_THAT(message(text), HasSubstr("five fields")) << text;
  }
  EXPECT_THAT(message("60 0 * * *"), HasSubstr("the minute '60'"));
  EXPECT_THAT(message("0 24 * * *"), HasSubstr("the hour '24'"));
  EXPECT_THAT(message("0 0 0 * *"), HasSubstr("the day '0'"));
  EXPECT_THAT(message("0 0 * 13 *"), HasSubstr("the month '13'"));
  EXPECT_THAT(message("0 0 * * mon"), HasSubstr("the weekday 'mon'"));
  EXPECT_THAT(message("*/0 0 * * *"), HasSubstr("the minute '*/0'"));
  EXPECT_THAT(message("5-1 0 * * *"), HasSubstr("the minute '5-1'"));
  EXPECT_THAT(message("1, 0 * * *"), HasSubstr("the minute '1,'"));
  EXPECT_THAT(message("1x 0 * * *"), HasSubstr("the minute '1x'"));
}

}  // namespace
}  // namespace recald::daemon::schedule_test
