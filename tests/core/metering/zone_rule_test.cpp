/// What clocks show after the last change that zone files list, to the end of 2100: held against
/// the C library, which has code of its own for these rules, and against calendars written by hand.
#include "core/metering/zone_rule.hpp"

#include <date/tz.h>
#include <gtest/gtest.h>

#include <random>

#include "c_library_zone.hpp"
#include "month_builder.hpp"

namespace recald::metering::zone_rule_test {
namespace {

using std::chrono::hours;
using std::chrono::seconds;
using testing::calendar;
using testing::CLibraryZone;
using testing::month;
using testing::utc;

// Every zone of the system at drawn times, twice a week, and to the second where the offset
// changes.
TEST(ZoneRule, EveryZoneShowsWhatTheCLibraryShows) {
  std::mt19937_64 random{20'370'101};
  int changes = 0;
  for (const date::time_zone& named : date::get_tzdb().zones) {
    SCOPED_TRACE(named.name());
    const LocalCalendar zone = calendar(named.name());
    const CLibraryZone expected{named.name().c_str()};
    Instant t = utc(2036, 1, 1);
    while (t < utc(2100, 12, 30)) {
      const Instant next = t + seconds{std::uniform_int_distribution<int>{1, 7 * 86'400}(random)};
      ASSERT_EQ(zone.utc_offset(next), expected.utc_offset(next)) << to_string(next);
      if (zone.utc_offset(t) != zone.utc_offset(next)) {
        Instant before = t;
        for (Instant after = next; after - before > seconds{1};) {
          const Instant middle = before + (after - before) / 2;
          (zone.utc_offset(middle) == zone.utc_offset(t) ? before : after) = middle;
        }
        ++changes;
        ASSERT_EQ(expected.utc_offset(before), zone.utc_offset(t)) << to_string(before);
        ASSERT_EQ(expected.utc_offset(before + seconds{1}), zone.utc_offset(next))
            << to_string(before);
      }
      t = next;
    }
  }
  EXPECT_GT(changes, 10'000);  // a hundred zones and more have two a year
}

/// "-3:30", "5", "0:45"
std::string drawn_time(std::mt19937_64& random, int least_h, int most_h) {
  const int whole = std::uniform_int_distribution{least_h, most_h}(random);
  const int minutes = std::uniform_int_distribution{0, 3}(random)*15;
  return std::to_string(whole) + (minutes == 0 ? "" : ":" + std::to_string(minutes));
}

/// A day of spring or of autumn: the C library takes the year of UTC, so not next to New Year.
std::string drawn_day(std::mt19937_64& random, bool is_spring) {
  const auto draw = [&](int least, int most) {
    return std::uniform_int_distribution{least, most}(random);
  };
  const int form = draw(0, 3);
  if (form == 0) return "J" + std::to_string(is_spring ? draw(40, 170) : draw(200, 350));
  if (form == 1) return std::to_string(is_spring ? draw(40, 170) : draw(200, 350));
  return "M" + std::to_string(is_spring ? draw(2, 6) : draw(8, 11)) + "." +
         std::to_string(draw(1, 5)) + "." + std::to_string(draw(0, 6));
}

// Either hemisphere, summer time of any length and sign, days counted in each of the three ways.
TEST(ZoneRule, DrawnRulesGoOnAsTheCLibrarySays) {
  std::mt19937_64 random{2'050};
  const auto is_drawn = [&] { return random() % 2 == 0; };
  for (int i = 0; i < 300; ++i) {
    const bool is_north = is_drawn();
    std::string rule = is_drawn() ? "ABC" : "<+0330>";
    rule += drawn_time(random, -13, 11);
    rule += is_drawn() ? "DEF" : "<-03>";
    if (is_drawn()) rule += drawn_time(random, -13, 11);
    for (const bool is_first : {true, false}) {
      rule += "," + drawn_day(random, is_first == is_north);
      if (is_drawn()) rule += "/" + drawn_time(random, -24, 50);
    }
    SCOPED_TRACE(rule);
    const std::vector<OffsetChange> changes = zone_rule_changes(rule);
    ASSERT_EQ(changes.size(), 260u);
    const CLibraryZone expected{rule.c_str()};
    for (std::size_t at = 1; at < changes.size(); ++at) {
      ASSERT_EQ(expected.utc_offset(changes[at].at), changes[at].utc_offset)
          << to_string(changes[at].at);
      ASSERT_EQ(expected.utc_offset(changes[at].at - seconds{1}), changes[at - 1].utc_offset)
          << to_string(changes[at].at);
    }
  }
}

TEST(ZoneRule, WhatIsNoRuleChangesNothing) {
  for (const char* rule :
       {"", "UTC0", "<+0330>-3:30", "ABC", "AB1CD,M3.5.0,M10.5.0", "CET-1CEST", "CET-1CEST,M3.5.0",
        "CET-1CEST,M3.5.0,M10.5.0/3 ", "CET-1CEST,M13.5.0,M10.5.0", "CET-1CEST,M3.6.0,M10.5.0",
        "CET-1CEST,M3.5.7,M10.5.0", "CET-1CEST,J0,J300", "CET-1CEST,M3.5.0/168,M10.5.0",
        "<+0330-3:30<+0430>,J79/24,J263/24", "CET-1CEST,M3.5,M10.5.0"}) {
    EXPECT_TRUE(zone_rule_changes(rule).empty()) << rule;
  }
  EXPECT_EQ(zone_rule_of("Nowhere/At_All"), "");
  EXPECT_EQ(zone_rule_of("Europe/Berlin"), "CET-1CEST,M3.5.0,M10.5.0/3");
}

// From calendars of those years: the last Sundays of March and October, the second of March and the
// first of November.
TEST(ZoneRule, DaysOfClockChangesAreTheCalendars) {
  const auto length_h = [](const char* zone, int year, unsigned number, unsigned day) {
    const TimeSpan span = calendar(zone).day_span(month(year, number) / std::chrono::day{day});
    return in_hours(span.length());
  };
  EXPECT_EQ(length_h("Europe/Berlin", 2038, 3, 28), 23.0);
  EXPECT_EQ(length_h("Europe/Berlin", 2050, 10, 30), 25.0);
  EXPECT_EQ(length_h("Europe/Dublin", 2040, 3, 25), 23.0);
  EXPECT_EQ(length_h("Europe/Dublin", 2040, 10, 28), 25.0);
  EXPECT_EQ(length_h("America/New_York", 2100, 3, 14), 23.0);
  EXPECT_EQ(length_h("America/New_York", 2100, 11, 7), 25.0);
  EXPECT_EQ(length_h("Australia/Lord_Howe", 2040, 10, 7), 23.5);
  EXPECT_EQ(length_h("Australia/Lord_Howe", 2040, 4, 1), 24.5);
  EXPECT_EQ(length_h("America/Nuuk", 2040, 3, 24), 23.0);  // at 23:00 of the day before
  EXPECT_EQ(length_h("Asia/Kathmandu", 2040, 3, 25), 24.0);
  EXPECT_EQ(calendar("Europe/Berlin").month_span(month(2040, 7)),
            (TimeSpan{utc(2040, 6, 30, 22), utc(2040, 7, 31, 22)}));
  EXPECT_EQ(calendar("Europe/Berlin").standard_offset(std::chrono::year{2040}), hours{1});
}

}  // namespace
}  // namespace recald::metering::zone_rule_test
