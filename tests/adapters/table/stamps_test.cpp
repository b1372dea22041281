#include "adapters/table/stamps.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace recald::table::stamps_test {
namespace {

using metering::Instant;
using metering::LocalCalendar;
using metering::to_string;
using std::chrono::hours;
using std::chrono::minutes;

std::string clock(std::string_view text, TimeFormat format) {
  const auto stamp = parse_stamp(text, format);
  return stamp ? to_string(stamp->clock) : "refused: " + stamp.error().message;
}

TEST(Stamps, TheOrderOfTheirPartsIsTold) {
  for (const char* text : {"2024-03-09 14:15", "2024/3/9 14:15:00", "2024-03-09T14:15:00.000",
                           "20240309 1415", "2024-Mar-09 2:15 PM"}) {
    EXPECT_EQ(clock(text, TimeFormat::year_first), "2024-03-09T14:15:00Z") << text;
  }
  for (const char* text : {"09/03/2024 14:15", "9.3.24 14:15", "09-Mar-2024 02:15:00 pm"}) {
    EXPECT_EQ(clock(text, TimeFormat::day_first), "2024-03-09T14:15:00Z") << text;
  }
  for (const char* text : {"03/09/2024 14:15", "3/9/24 2:15 PM", "Mar 9, 2024 14:15"}) {
    EXPECT_EQ(clock(text, TimeFormat::month_first), "2024-03-09T14:15:00Z") << text;
  }
}

TEST(Stamps, MidnightHasThreeNames) {
  EXPECT_EQ(clock("31/01/2024 24:00", TimeFormat::day_first), "2024-02-01T00:00:00Z");
  EXPECT_EQ(clock("01/02/2024 00:00", TimeFormat::day_first), "2024-02-01T00:00:00Z");
  EXPECT_EQ(clock("2/1/2024 12:00 AM", TimeFormat::month_first), "2024-02-01T00:00:00Z");
  EXPECT_FALSE(parse_stamp("01/02/2024", TimeFormat::day_first)->has_time);
}

TEST(Stamps, OffsetsAreTakenWhereTheyStand) {
  const auto stamp = parse_stamp("09/03/2024 14:15 +01:00", TimeFormat::day_first);
  ASSERT_TRUE(stamp.has_value());
  EXPECT_EQ(stamp->utc_offset, std::chrono::seconds{3600});
  EXPECT_EQ(parse_stamp("2024-03-09T14:15:00Z", TimeFormat::year_first)->utc_offset,
            std::chrono::seconds{0});
  EXPECT_FALSE(parse_stamp("2024-03-09T14:15:00", TimeFormat::year_first)->utc_offset.has_value());
}

TEST(Stamps, SpreadsheetDaysAndSeconds) {
  EXPECT_EQ(clock("45292", TimeFormat::excel), "2024-01-01T00:00:00Z");
  EXPECT_EQ(clock("45292.0104166667", TimeFormat::excel), "2024-01-01T00:15:00Z");
  EXPECT_EQ(clock("45292,5", TimeFormat::excel), "2024-01-01T12:00:00Z");
  EXPECT_EQ(clock("1704067200", TimeFormat::unix), "2024-01-01T00:00:00Z");
  EXPECT_EQ(clock("1704067200000", TimeFormat::unix), "2024-01-01T00:00:00Z");
}

TEST(Stamps, WhatIsNoneSaysSo) {
  for (const char* text : {"", "soon", "31/02/2024 10:00", "13/13/2024 10:00", "09/03/2024 25:00",
                           "09/03/2024 10:61", "09/03/2024 10:00 x", "9/3/224 10:00",
                           "09/03/1969 10:00", "09/03/2101 10:00", "09/03/2024 13:00 PM"}) {
    EXPECT_FALSE(parse_stamp(text, TimeFormat::day_first).has_value()) << text;
  }
  EXPECT_EQ(parse_stamp("x", TimeFormat::day_first).error().message,
            "timestamp 'x' is not dd/mm/yyyy");
  EXPECT_FALSE(parse_stamp("7", TimeFormat::excel).has_value());
  EXPECT_FALSE(parse_stamp("1e300", TimeFormat::unix).has_value());
}

Instant shown(const std::string& text) { return parse_stamp(text, TimeFormat::year_first)->clock; }

// 27 October 2024 in Berlin: 02:00 comes at 00:00 and at 01:00 UTC.
TEST(Stamps, TheHourThatComesTwiceIsToldApartByItsOrder) {
  const auto berlin = LocalCalendar::open("Europe/Berlin");
  ClockReader reader{*berlin};
  std::vector<std::string> instants;
  for (const char* text : {"2024-10-27 01:30", "2024-10-27 02:00", "2024-10-27 02:30",
                           "2024-10-27 02:00", "2024-10-27 02:30", "2024-10-27 03:00"}) {
    instants.push_back(to_string(*reader.instant_of(shown(text))));
  }
  EXPECT_EQ(instants, (std::vector<std::string>{"2024-10-26T23:30:00Z", "2024-10-27T00:00:00Z",
                                                "2024-10-27T00:30:00Z", "2024-10-27T01:00:00Z",
                                                "2024-10-27T01:30:00Z", "2024-10-27T02:00:00Z"}));
}

// Sorted by what is written: both of a kind one after the other.
TEST(Stamps, AFileSortedByItsStampsHasThemInPairs) {
  const auto berlin = LocalCalendar::open("Europe/Berlin");
  ClockReader reader{*berlin};
  std::vector<std::string> instants;
  for (const char* text : {"2024-10-27 02:00", "2024-10-27 02:00", "2024-10-27 02:30",
                           "2024-10-27 02:30", "2024-10-27 03:00"}) {
    instants.push_back(to_string(*reader.instant_of(shown(text))));
  }
  EXPECT_EQ(instants, (std::vector<std::string>{"2024-10-27T00:00:00Z", "2024-10-27T01:00:00Z",
                                                "2024-10-27T00:30:00Z", "2024-10-27T01:30:00Z",
                                                "2024-10-27T02:00:00Z"}));
}

TEST(Stamps, TheHourThatIsLeftOutHasNoInstant) {
  const auto berlin = LocalCalendar::open("Europe/Berlin");
  ClockReader reader{*berlin};
  EXPECT_EQ(to_string(*reader.instant_of(shown("2024-03-31 01:45"))), "2024-03-31T00:45:00Z");
  EXPECT_FALSE(reader.instant_of(shown("2024-03-31 02:00")).has_value());
  EXPECT_EQ(to_string(*reader.instant_of(shown("2024-03-31 03:00"))), "2024-03-31T01:00:00Z");
}

}  // namespace
}  // namespace recald::table::stamps_test
