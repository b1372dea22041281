#include "adapters/table/clock_labels.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace recald::table::clock_labels_test {
namespace {

using metering::Day;
using metering::Instant;
using metering::LocalCalendar;
using std::chrono::days;
using std::chrono::seconds;
using std::chrono::sys_days;
using ::testing::HasSubstr;

/// Labels of whole days from intervals that are known.
struct Made {
  ClockFormat format;
  seconds interval;
  int gap_on_usual_days = 0;  ///< A label that other days may lack.
};

LabelledDays made(const LocalCalendar& calendar, const Made& as, const char* first, int count) {
  LabelledDays labelled;
  const sys_days begin{*metering::parse_day(first)};
  for (int i = 0; i < count; ++i) {
    const sys_days date = begin + days{i};
    const metering::TimeSpan span = calendar.day_span(Day{date});
    int number = 0;
    for (Instant t = span.begin; t < span.end; t += as.interval) {
      ++number;
      const Instant shown_end = t + as.interval + calendar.utc_offset(t + as.interval);
      const auto start = t + calendar.utc_offset(t) - Instant{date};
      int label = number;
      if (as.format == ClockFormat::hour_ending) label = static_cast<int>(start / as.interval) + 1;
      if (as.format == ClockFormat::time)
        label = static_cast<int>((shown_end - Instant{date}) / as.interval);
      if (span.length() == days{1} && label == as.gap_on_usual_days) continue;
      labelled.take(date, label, false);
    }
  }
  return labelled;
}

// Every way to count, in zones whose clocks change at other hours, by hours and parts of them.
TEST(ClockLabels, DaysOfOtherLengthDecide) {
  for (const char* zone : {"Europe/Berlin", "Europe/London", "Europe/Lisbon", "America/New_York",
                           "Australia/Sydney"}) {
    const auto calendar = LocalCalendar::open(zone);
    for (const int minutes : {60, 30, 15}) {
      for (const ClockFormat format :
           {ClockFormat::hour_ending, ClockFormat::interval_number, ClockFormat::time}) {
        for (const char* first : {"2025-03-01", "2025-10-01", "2025-01-01"}) {
          SCOPED_TRACE(std::string{zone} + " " + std::to_string(minutes) + " " +
                       std::string{to_string(format)} + " " + first);
          const int count = std::string_view{first} == "2025-01-01" ? 365 : 40;
          const LabelledDays labelled =
              made(*calendar, {format, std::chrono::minutes{minutes}, 7}, first, count);
          const ClockLabels decided = labelled.decide(*calendar, ClockFormat::interval_number);
          ASSERT_TRUE(decided.format.has_value()) << decided.because;
          EXPECT_EQ(*decided.format, format) << decided.because;
          EXPECT_THAT(decided.because, HasSubstr("a day of 2"));
        }
      }
    }
  }
}

TEST(ClockLabels, WithoutSuchADayItMakesNoDifference) {
  const auto berlin = LocalCalendar::open("Europe/Berlin");
  const LabelledDays labelled =
      made(*berlin, {ClockFormat::hour_ending, std::chrono::hours{1}}, "2025-06-01", 30);
  const ClockLabels decided = labelled.decide(*berlin, ClockFormat::interval_number);
  EXPECT_EQ(decided.format, ClockFormat::interval_number);
  EXPECT_THAT(decided.because, HasSubstr("no day of 23 or 25 hours"));
}

// 24 labels on every day, with values: on the day of 23 hours nothing shows which is too many.
TEST(ClockLabels, WhatNothingShowsIsLeftOpen) {
  const auto berlin = LocalCalendar::open("Europe/Berlin");
  const auto labelled = [&](int empty_label) {
    LabelledDays all;
    for (int date = 25; date <= 31; ++date) {
      for (int label = 1; label <= 24; ++label) {
        all.take(sys_days{std::chrono::year{2025} / 3 / date}, label,
                 date == 30 && label == empty_label);
      }
    }
    return all.decide(*berlin, ClockFormat::interval_number);
  };
  EXPECT_FALSE(labelled(0).format.has_value());
  EXPECT_THAT(labelled(0).because, HasSubstr("2025-03-30, a day of 23 hours"));
  EXPECT_EQ(labelled(3).format, ClockFormat::hour_ending);       // zero in the skipped hour
  EXPECT_EQ(labelled(24).format, ClockFormat::interval_number);  // zero at the end
}

TEST(ClockLabels, DaysThatContradictEachOtherAreNamed) {
  const auto berlin = LocalCalendar::open("Europe/Berlin");
  LabelledDays labelled;
  const auto add = [&](sys_days date, int from, int to, int without) {
    for (int label = from; label <= to; ++label) {
      if (label != without) labelled.take(date, label, false);
    }
  };
  add(sys_days{std::chrono::year{2025} / 3 / 29}, 1, 24, 0);
  add(sys_days{std::chrono::year{2025} / 3 / 30}, 1, 24, 3);
  add(sys_days{std::chrono::year{2025} / 3 / 31}, 1, 24, 0);
  add(sys_days{std::chrono::year{2025} / 10 / 26}, 1, 25, 0);
  const ClockLabels decided = labelled.decide(*berlin, ClockFormat::interval_number);
  EXPECT_FALSE(decided.format.has_value());
  EXPECT_THAT(decided.because, HasSubstr("contradict each other"));
}

TEST(ClockLabels, NumbersInManyForms) {
  for (const char* text : {"7", "07", "H07", "HE 7", "SP7", "h_07", "7.0", "Stunde 7"}) {
    EXPECT_EQ(parse_label(text), 7) << text;
  }
  for (const char* text : {"", "x", "7.5", "700", "7 kWh", "07:00"}) {
    EXPECT_FALSE(parse_label(text).has_value()) << text;
  }
}

}  // namespace
}  // namespace recald::table::clock_labels_test
