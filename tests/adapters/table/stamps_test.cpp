#include "adapters/table/cells/stamps.hpp"

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

// Text for a moment in every way that exports have: order, month, clock, blanks, weekday, zone.
struct Moment {
  int year, month, day, hour, minute;
};

std::string two(int number) { return (number < 10 ? "0" : "") + std::to_string(number); }

std::string date_of(const Moment& t, TimeFormat format, const std::string& sign,
                    const std::string& month) {
  const std::string year = std::to_string(t.year);
  if (format == TimeFormat::year_first) return year + sign + month + sign + two(t.day);
  if (format == TimeFormat::day_first) return two(t.day) + sign + month + sign + year;
  return month + sign + two(t.day) + sign + year;
}

std::string clock_of(const Moment& t, int way, const std::string& blank) {
  const int twelve = t.hour % 12 == 0 ? 12 : t.hour % 12;
  const std::string half = t.hour < 12 ? "a" : "p";
  switch (way) {
    case 0:
      return two(t.hour) + ":" + two(t.minute);
    case 1:
      return two(t.hour) + ":" + two(t.minute) + ":00";
    case 2:
      return std::to_string(twelve) + ":" + two(t.minute) + blank + half + "m";
    case 3:
      return two(twelve) + ":" + two(t.minute) + ":00" + blank + half + "." + blank + "m.";
    case 4:
      return two(t.hour) + "h" + two(t.minute);
    case 5:
      return two(t.hour) + "." + two(t.minute);
    default:
      return two(t.hour) + ":" + two(t.minute) + " Uhr";
  }
}

TEST(Stamps, ComeBackFromAnyForm) {
  const std::vector<std::string> blanks{" ", "\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89",
                                        ",\xC2\xA0"};
  const std::vector<std::string> days{"",
                                      "Mon ",
                                      "lun. ",
                                      "Montag, ",
                                      "poniedzia\xC5\x82"
                                      "ek ",
                                      "ma "};
  const std::vector<std::vector<std::string>> september{{"Sep", "September", "Sept.", "septembre",
                                                         "septiembre", "settembre", "setembro",
                                                         "syyskuu", "wrze\xC5\x9Bnia"}};
  const std::vector<std::string> ends{"", "\xE2\x80\x8E"};
  const Moment midnight{2025, 9, 1, 0, 0};
  const Moment noon{2025, 9, 1, 12, 15};
  const Moment evening{2025, 9, 1, 23, 45};
  std::size_t tried = 0;
  for (const TimeFormat format :
       {TimeFormat::year_first, TimeFormat::day_first, TimeFormat::month_first}) {
    for (const Moment& t : {midnight, noon, evening}) {
      std::vector<std::string> dates;
      for (const char* sign : {"-", "/", "."}) dates.push_back(date_of(t, format, sign, "09"));
      for (const std::string& month : september.front()) {
        dates.push_back(date_of(t, format, " ", month));
        dates.push_back(date_of(t, format, "-", month));
      }
      for (const std::string& date : dates) {
        for (const std::string& day : days) {
          for (const std::string& blank : blanks) {
            for (int way = 0; way < 7; ++way) {
              for (const std::string& end : ends) {
                const std::string text =
                    end + day + date + blank +
                    clock_of(t, way, blank.back() == ' ' ? " " : "\xE2\x80\xAF") + end;
                const std::string wanted =
                    "2025-09-01T" + two(t.hour) + ":" + two(t.minute) + ":00Z";
                ASSERT_EQ(clock(text, format), wanted) << text;
                ++tried;
              }
            }
          }
        }
      }
    }
  }
  EXPECT_GT(tried, 10'000u);
}

TEST(Stamps, AWeekdayInFrontIsNoMonth) {
  // Tuesday is mar. in French, Italian and Spanish, and March in English.
  EXPECT_EQ(clock("mar. 09/02/2025 14:15", TimeFormat::month_first), "2025-09-02T14:15:00Z");
  EXPECT_EQ(clock("mar. 02/09/2025 14:15", TimeFormat::day_first), "2025-09-02T14:15:00Z");
  EXPECT_EQ(clock("Tue Mar 09 2025 14:15:00 GMT+0200 (CEST)", TimeFormat::month_first),
            "2025-03-09T14:15:00Z");
  EXPECT_EQ(clock("2025-10-01 to 2025-10-02", TimeFormat::year_first), "2025-10-01T00:00:00Z");
}

TEST(Stamps, LettersOfAZoneAreOffsets) {
  const auto offset = [](const std::string& text, TimeFormat format = TimeFormat::day_first) {
    const auto stamp = parse_stamp(text, format);
    return stamp && stamp->utc_offset ? static_cast<int>(stamp->utc_offset->count() / 60) : -9999;
  };
  EXPECT_EQ(offset("01-Sep-25 12:15:00 AM EDT"), -240);
  EXPECT_EQ(offset("02-Nov-25 01:15:00 AM EST"), -300);
  EXPECT_EQ(offset("01.09.2025 00:15 MESZ"), 120);
  EXPECT_EQ(offset("01.09.2025 00:15 CET"), 60);
  EXPECT_EQ(offset("01/09/2025 00:15 BST"), 60);
  EXPECT_EQ(offset("01/09/2025 00:15 GMT"), 0);
  EXPECT_EQ(offset("01/09/2025 00:15 UTC+2"), 120);
  EXPECT_EQ(offset("2025-09-01 00:15 AEST", TimeFormat::year_first), 600);
  EXPECT_EQ(offset("2025-09-01T00:15:00.123+02:00[Europe/Berlin]", TimeFormat::year_first), 120);
  EXPECT_TRUE(parse_stamp("01.09.2025 00:15 MESZ", TimeFormat::day_first)->is_zone_named);
  EXPECT_FALSE(parse_stamp("01.09.2025 00:15 UTC", TimeFormat::day_first)->is_zone_named);
  EXPECT_EQ(
      parse_stamp("01.09.2025 00:15 XYZ", TimeFormat::day_first).error().message,
      "timestamp '01.09.2025 00:15 XYZ' is not dd/mm/yyyy; it ends in 'XYZ', which is no time "
      "zone that recald knows; an offset such as +01:00 is clear");
}

TEST(Stamps, OfFromAndToTheFirstCounts) {
  const std::string en_dash = "\xE2\x80\x93";
  for (const std::string& text : std::vector<std::string>{
           "01.09.2025 00:15 - 00:30", "01.09.2025 00:15-00:30",
           "01.09.2025 00:15 " + en_dash + " 01.09.2025 00:30",
           "01.09.2025 00:15" + en_dash + "00:30", "01.09.2025 00:15 bis 01.09.2025 00:30",
           "von 01.09.2025 00:15 bis 00:30", "01/09/2025 00:15 to 01/09/2025 00:30",
           "du 01/09/2025 00:15 au 01/09/2025 00:30", "01/09/2025 00:15 \xC3\xA0 00:30",
           "01/09/2025 00:15 a 00:30", "01/09/2025 00:15 hasta 00:30", "01/09/2025 00:15 tot 00:30",
           "01/09/2025 00:15 til 00:30", "01/09/2025 00:15 do 00:30",
           "01/09/2025 00:15 al 01/09/2025 00:30"}) {
    const auto stamp = parse_stamp(text, TimeFormat::day_first);
    ASSERT_TRUE(stamp.has_value()) << text;
    EXPECT_EQ(to_string(stamp->clock), "2025-09-01T00:15:00Z") << text;
    EXPECT_TRUE(stamp->is_range) << text;
    EXPECT_FALSE(stamp->utc_offset.has_value()) << text;
  }
  for (const char* text :
       {"2025-09-01T00:15:00Z/2025-09-01T00:30:00Z", "2025-09-01T00:15:00+00:00/PT15M",
        "2025-09-01 00:15 to 2025-09-01 00:30", "2025-09-01 00:15-00:30"}) {
    EXPECT_EQ(clock(text, TimeFormat::year_first), "2025-09-01T00:15:00Z") << text;
    EXPECT_TRUE(parse_stamp(text, TimeFormat::year_first)->is_range) << text;
  }
  // With the year in front, this is how ISO writes an offset.
  EXPECT_EQ(parse_stamp("2025-09-01 00:15-05:00", TimeFormat::year_first)->utc_offset,
            std::chrono::seconds{-5 * 3600});
  // The end lies before the start: no range.
  EXPECT_FALSE(
      parse_stamp("02.09.2025 00:15 - 01.09.2025 00:30", TimeFormat::day_first).has_value());
}

TEST(Stamps, ClocksOfTheirOwnColumn) {
  const auto time = [](const std::string& text) {
    const auto parsed = parse_clock(text);
    return parsed ? static_cast<int>(parsed->time.count() / 60) : -1;
  };
  EXPECT_EQ(time("00:15"), 15);
  EXPECT_EQ(time("12:15:00 a.m."), 15);
  EXPECT_EQ(time("12:15\xE2\x80\xAFPM"), 735);
  EXPECT_EQ(time("14h15"), 855);
  EXPECT_EQ(time("klo 14.15"), 855);
  EXPECT_EQ(time("24:00"), 1440);
  EXPECT_EQ(time("00:00 - 00:15"), 0);
  EXPECT_EQ(time("23:45\xE2\x80\x93"
                 "00:00"),
            1425);
  EXPECT_EQ(time("23:45-24:00"), 1425);
  EXPECT_EQ(time("07"), 420);
  EXPECT_EQ(time("07-08"), 420);
  EXPECT_EQ(time("23-24"), 1380);
  EXPECT_TRUE(parse_clock("00:00 - 00:15")->is_range);
  EXPECT_EQ(parse_clock("12:15:00 AM EDT")->utc_offset, std::chrono::seconds{-4 * 3600});
  for (const char* text : {"", "25", "25:00", "soon", "00:15-05:00", "07-09", "1.5 kWh"}) {
    EXPECT_EQ(time(text), -1) << text;
  }
}

TEST(Stamps, CountsOfAnyUnitSince1970) {
  for (const char* text :
       {"1704067200", "1704067200.0", "1704067200000", "1704067200000000", "1704067200000000000"}) {
    EXPECT_EQ(clock(text, TimeFormat::unix), "2024-01-01T00:00:00Z") << text;
  }
}

TEST(Stamps, AHeaderMaySayTheOffset) {
  EXPECT_EQ(offset_said("timestamp_utc"), std::chrono::seconds{0});
  EXPECT_EQ(offset_said("Time (GMT)"), std::chrono::seconds{0});
  EXPECT_EQ(offset_said("Zeit (UTC+1)"), hours{1});
  EXPECT_EQ(offset_said("Time UTC-05:00"), hours{-5});
  EXPECT_FALSE(offset_said("Time").has_value());
  EXPECT_FALSE(offset_said("Butchers").has_value());
}

TEST(Stamps, ARefusalNamesTheOrderThatWouldDo) {
  EXPECT_EQ(parse_stamp("31/03/2024 10:00", TimeFormat::month_first).error().message,
            "timestamp '31/03/2024 10:00' is not mm/dd/yyyy; it would be one as dd/mm/yyyy");
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

// Devices that stamp some seconds beside the full minute show the jump beside it, too.
TEST(Stamps, SecondsBesideAClockChangeBelongToTheMinute) {
  for (const char* zone : {"Europe/Berlin", "Europe/Lisbon", "America/Chicago"}) {
    const auto calendar = LocalCalendar::open(zone);
    for (const int step_min : {15, 60}) {
      // Constant, or now so and now so; 100: up to 40 s late.
      for (const int beside_s : {-1, -3, 2, 0, 100}) {
        SCOPED_TRACE(std::string{zone} + " every " + std::to_string(step_min) + " min, beside " +
                     std::to_string(beside_s));
        for (const auto& first : {shown("2024-03-30 12:00"), shown("2024-10-26 12:00"),
                                  shown("2024-03-09 12:00"), shown("2024-11-02 12:00")}) {
          ClockReader reader{*calendar};
          for (Instant t = first; t < first + std::chrono::hours{36};
               t += std::chrono::minutes{step_min}) {
            const auto hour = (t - first) / std::chrono::hours{1};
            const std::chrono::seconds beside{beside_s == 100 ? 7 * hour % 41 : beside_s};
            const auto read = reader.instant_of(t + calendar->utc_offset(t) + beside);
            ASSERT_TRUE(read.has_value()) << to_string(t);
            EXPECT_EQ(to_string(*read), to_string(t + beside));
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace recald::table::stamps_test
