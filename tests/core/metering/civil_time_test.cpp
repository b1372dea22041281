/// Clock changes from the zone files: facts of single dates, each checked by hand.
#include "core/metering/civil_time.hpp"

#include <gtest/gtest.h>

#include "month_builder.hpp"

namespace recald::metering::civil_time_test {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using testing::calendar;
using testing::month;
using testing::utc;

Day day(int year, unsigned number, unsigned d) { return month(year, number) / std::chrono::day{d}; }

/// Hours that a local day has.
double length_h(const char* zone, Day date) {
  return static_cast<double>(calendar(zone).day_span(date).length().count()) / 3600.0;
}

TEST(LocalCalendar, DaysOfClockChangesAreShorterOrLonger) {
  EXPECT_EQ(length_h("America/New_York", day(2021, 3, 13)), 24.0);
  EXPECT_EQ(length_h("America/New_York", day(2021, 3, 14)), 23.0);
  EXPECT_EQ(length_h("America/New_York", day(2021, 11, 7)), 25.0);
  // Lord Howe Island moves its clocks by half an hour.
  EXPECT_EQ(length_h("Australia/Lord_Howe", day(2021, 10, 3)), 23.5);
  EXPECT_EQ(length_h("Australia/Lord_Howe", day(2021, 4, 4)), 24.5);
  EXPECT_EQ(length_h("UTC", day(2021, 3, 14)), 24.0);
}

TEST(LocalCalendar, MonthsJoinWithoutGapAndLastTheirHours) {
  const LocalCalendar new_york = calendar("America/New_York");
  EXPECT_EQ(new_york.month_span(month(2021, 1)),
            (TimeSpan{utc(2021, 1, 1, 5), utc(2021, 2, 1, 5)}));
  EXPECT_EQ(new_york.month_span(month(2021, 3)).length(), hours{31 * 24 - 1});
  EXPECT_EQ(new_york.month_span(month(2021, 11)).length(), hours{30 * 24 + 1});
  for (Month m = month(1971, 1); m < month(2100, 12); m = next_month(m)) {
    ASSERT_EQ(new_york.month_span(m).end, new_york.month_span(next_month(m)).begin) << to_string(m);
  }
}

// A clock that was never set, and a counter of seconds that is full: some time, and no crash.
TEST(LocalCalendar, BeyondTheKnownYearsTheNearestOffsetHolds) {
  const LocalCalendar new_york = calendar("America/New_York");
  EXPECT_EQ(new_york.utc_offset(utc(2106, 2, 7)), -hours{5});
  EXPECT_EQ(new_york.utc_offset(utc(1900, 1, 1)), -hours{5});
  EXPECT_EQ(new_york.local_time(utc(2106, 7, 1)).date, day(2106, 6, 30));
  EXPECT_EQ(new_york.day_span(day(2106, 7, 1)).begin, kLatestInstant);
}

// In São Paulo the clock jumped from 2017-10-15 00:00 to 01:00, which is 03:00 UTC.
TEST(LocalCalendar, DayWithoutMidnightBeginsAtTheJump) {
  const LocalCalendar sao_paulo = calendar("America/Sao_Paulo");
  const TimeSpan span = sao_paulo.day_span(day(2017, 10, 15));
  EXPECT_EQ(span.begin, utc(2017, 10, 15, 3));
  EXPECT_EQ(span.length(), hours{23});
  EXPECT_EQ(sao_paulo.local_time(span.begin).minute_of_day, 60);
  EXPECT_EQ(sao_paulo.local_time(span.begin - std::chrono::seconds{1}).date, day(2017, 10, 14));
  EXPECT_EQ(sao_paulo.day_span(day(2017, 10, 14)).end, span.begin);
  EXPECT_EQ(sao_paulo.first_instant(day(2017, 10, 15), 30), span.begin);
}

// In Havana 2015-11-01 01:00 became 00:00: midnight, and with it November, began twice.
TEST(LocalCalendar, RepeatedMidnightBeginsTheDayTheFirstTime) {
  const LocalCalendar havana = calendar("America/Havana");
  EXPECT_EQ(havana.day_span(day(2015, 11, 1)),
            (TimeSpan{utc(2015, 11, 1, 4), utc(2015, 11, 2, 5)}));
  EXPECT_EQ(havana.month_span(month(2015, 11)).begin, utc(2015, 11, 1, 4));
  EXPECT_EQ(havana.month_span(month(2015, 10)).end, utc(2015, 11, 1, 4));
  EXPECT_EQ(havana.local_time(utc(2015, 11, 1, 4)).minute_of_day, 0);
  EXPECT_EQ(havana.local_time(utc(2015, 11, 1, 5)).minute_of_day, 0);
  EXPECT_EQ(havana.month_of(utc(2015, 11, 1, 5)), month(2015, 11));
}

// Samoa crossed the date line: 2011-12-30 never was.
TEST(LocalCalendar, DayThatNeverWasIsEmpty) {
  const LocalCalendar apia = calendar("Pacific/Apia");
  EXPECT_EQ(apia.day_span(day(2011, 12, 30)),
            (TimeSpan{utc(2011, 12, 30, 10), utc(2011, 12, 30, 10)}));
  EXPECT_EQ(apia.local_time(utc(2011, 12, 30, 10)).date, day(2011, 12, 31));
}

TEST(LocalCalendar, HourThatIsShownTwiceIsFoundTheFirstTimeAndTheSkippedOneAtTheJump) {
  const LocalCalendar new_york = calendar("America/New_York");
  EXPECT_EQ(new_york.first_instant(day(2021, 11, 7), 90), utc(2021, 11, 7, 5, 30));
  EXPECT_EQ(new_york.first_instant(day(2021, 3, 14), 150), utc(2021, 3, 14, 7));
  EXPECT_EQ(new_york.first_instant(day(2021, 7, 1), 12 * 60), utc(2021, 7, 1, 16));
}

TEST(LocalCalendar, LocalTimeIsWhatTheWallClockShows) {
  const LocalCalendar kolkata = calendar("Asia/Kolkata");
  const LocalTime local = kolkata.local_time(utc(2021, 1, 31, 18, 45));
  EXPECT_EQ(local.date, day(2021, 2, 1));
  EXPECT_EQ(local.minute_of_day, 15);
  EXPECT_EQ(kolkata.month_of(utc(2021, 1, 31, 18, 45)), month(2021, 2));
  EXPECT_EQ(kolkata.utc_offset(utc(2021, 1, 1)), minutes{330});
  EXPECT_EQ(kolkata.zone_name(), "Asia/Kolkata");
}

TEST(LocalCalendar, UnknownZoneIsOneSentence) {
  const auto calendar = LocalCalendar::open("America/Nowhere");
  ASSERT_FALSE(calendar.has_value());
  EXPECT_EQ(calendar.error().code, ErrorCode::not_found);
  EXPECT_EQ(calendar.error().message,
            "time zone 'America/Nowhere' is not in this system's zone files; use an IANA name such "
            "as America/New_York");
  EXPECT_FALSE(LocalCalendar::open("").has_value());
}

TEST(LocalCalendar, AMisspeltZoneGetsTheNearest) {
  for (const auto& [zone, meant] :
       {std::pair{"Europe/Berln", "Europe/Berlin"}, std::pair{"berlin", "Europe/Berlin"},
        std::pair{"Europe/Chicago", "America/Chicago"}}) {
    EXPECT_EQ(LocalCalendar::open(zone).error().message,
              std::string{"time zone '"} + zone +
                  "' is not in this system's zone files; did you mean '" + meant + "'?");
  }
}

TEST(MonthArithmetic, CrossesYears) {
  EXPECT_EQ(next_month(month(2021, 12)), month(2022, 1));
  EXPECT_EQ(previous_month(month(2022, 1)), month(2021, 12));
  EXPECT_EQ(months_between(month(2021, 11), month(2023, 2)), 15);
  EXPECT_EQ(months_between(month(2023, 2), month(2021, 11)), -15);
  EXPECT_EQ(days_in(month(2024, 2)), 29);
  EXPECT_EQ(days_in(month(2100, 2)), 28);
  EXPECT_EQ(days_in(month(2021, 12)), 31);
}

TEST(TimeSpan, IsHalfOpen) {
  const TimeSpan span{utc(2021, 1, 1), utc(2021, 1, 2)};
  EXPECT_TRUE(span.contains(utc(2021, 1, 1)));
  EXPECT_FALSE(span.contains(utc(2021, 1, 2)));
  EXPECT_EQ(span.length(), hours{24});
}

TEST(ToString, IsIso8601) {
  EXPECT_EQ(to_string(month(2016, 3)), "2016-03");
  EXPECT_EQ(to_string(day(2016, 3, 1)), "2016-03-01");
  EXPECT_EQ(to_string(utc(2016, 3, 1, 5) + std::chrono::seconds{7}), "2016-03-01T05:00:07Z");
}

TEST(ParseMonth, TakesOnlyYearDashMonth) {
  EXPECT_EQ(*parse_month("2016-03"), month(2016, 3));
  EXPECT_EQ(*parse_month("1971-01"), month(1971, 1));
  EXPECT_EQ(*parse_month("2100-12"), month(2100, 12));
  for (const char* text : {"", "2016", "2016-3", "2016-13", "2016-00", "2016/03", "16-03",
                           "2016--3", "2016-+3", " 2016-3", "1970-12", "2101-01", "2016-03-01"}) {
    SCOPED_TRACE(text);
    const auto parsed = parse_month(text);
    ASSERT_FALSE(parsed.has_value());
    EXPECT_EQ(parsed.error().code, ErrorCode::malformed);
    EXPECT_EQ(
        parsed.error().message,
        "'" + std::string{text} + "' is not a month between 1971-01 and 2100-12; write YYYY-MM");
  }
}

TEST(ParseDay, TakesOnlyDaysOfTheCalendar) {
  EXPECT_EQ(*parse_day("2024-02-29"), day(2024, 2, 29));
  EXPECT_EQ(*parse_day("2021-12-31"), day(2021, 12, 31));
  for (const char* text : {"", "2016-03", "2023-02-29", "2021-04-31", "2021-04-00", "2021-4-01",
                           "2021-04-1", "2021/04/01", "2021-04--1", "2021-04-01T", "2101-01-01"}) {
    SCOPED_TRACE(text);
    const auto parsed = parse_day(text);
    ASSERT_FALSE(parsed.has_value());
    EXPECT_EQ(parsed.error().code, ErrorCode::malformed);
    EXPECT_EQ(parsed.error().message,
              "'" + std::string{text} + "' is not a date of 1971 to 2100; write YYYY-MM-DD");
  }
}

}  // namespace
}  // namespace recald::metering::civil_time_test
