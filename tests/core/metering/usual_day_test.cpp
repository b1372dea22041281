#include "core/metering/months/usual_day.hpp"

#include <gtest/gtest.h>

#include "month_builder.hpp"

namespace recald::metering::usual_day_test {
namespace {

using testing::calendar;
using testing::kQuarter;
using testing::utc;

/// Days from 1 March on, UTC+1 in winter: 40 kW from six to six by the local clock, else 10.
Reading office(int day, int quarter, const LocalCalendar& zone, Validity validity = Validity::ok) {
  const Instant start = utc(2024, 3, 1) + std::chrono::days{day} + quarter * kQuarter;
  const int minute = zone.local_time(start).minute_of_day;
  return {0, start, minute >= 360 && minute < 1080 ? 40.0 : 10.0, validity};
}

TEST(UsualDay, IsTheMeanAtEachTimeOfTheLocalDay) {
  const LocalCalendar zone = calendar("Europe/Zurich");
  UsualDay usual{zone, kQuarter};
  for (int day = 0; day < 10; ++day) {
    for (int quarter = 0; quarter < 96; ++quarter) usual.observe(office(day, quarter, zone));
  }
  EXPECT_DOUBLE_EQ(usual.expected_kW(utc(2024, 3, 20, 4, 45)), 10.0);  // 5:45 in Zurich
  EXPECT_DOUBLE_EQ(usual.expected_kW(utc(2024, 3, 20, 5)), 40.0);
  EXPECT_DOUBLE_EQ(usual.expected_kW(utc(2024, 7, 20, 4)), 40.0);  // summer time
  EXPECT_DOUBLE_EQ(usual.shape()(utc(2024, 3, 20, 12)), 40.0);
}

TEST(UsualDay, OnlyMeasurementsTeach) {
  const LocalCalendar zone = calendar("Europe/Zurich");
  UsualDay usual{zone, kQuarter};
  EXPECT_EQ(usual.expected_kW(utc(2024, 3, 1)), 0.0);
  for (const Validity validity :
       {Validity::scaled, Validity::suspect, Validity::filled, Validity::missing}) {
    usual.observe(office(0, 40, zone, validity));
  }
  usual.observe({0, utc(2024, 3, 1), testing::kBlank, Validity::ok});
  EXPECT_EQ(usual.expected_kW(utc(2024, 3, 1, 10)), 0.0);
  usual.observe(office(0, 40, zone));
  EXPECT_DOUBLE_EQ(usual.expected_kW(utc(2024, 3, 2, 10)), 40.0);
  // Never measured at that time: the mean of what is known.
  EXPECT_DOUBLE_EQ(usual.expected_kW(utc(2024, 3, 2, 23)), 40.0);
}

TEST(UsualDay, ForgetsWithinWeeks) {
  const LocalCalendar zone = calendar("Europe/Zurich");
  UsualDay usual{zone, kQuarter};
  for (int day = 0; day < 300; ++day) {
    usual.observe({0, utc(2024, 1, 1) + std::chrono::days{day}, 100.0, Validity::ok});
  }
  for (int day = 300; day < 340; ++day) {
    usual.observe({0, utc(2024, 1, 1) + std::chrono::days{day}, 20.0, Validity::ok});
  }
  // The clock changed between: the winter's times are others than the summer's.
  EXPECT_LT(usual.expected_kW(utc(2025, 1, 1)), 32.0);
}

TEST(UsualDay, RunningBackwardsIsNoShape) {
  UsualDay usual{calendar("UTC"), kQuarter};
  usual.observe({0, utc(2024, 1, 1), -50.0, Validity::ok});
  EXPECT_EQ(usual.expected_kW(utc(2024, 1, 2)), 0.0);
}

}  // namespace
}  // namespace recald::metering::usual_day_test
