#include "core/metering/months/close_month.hpp"

#include <gtest/gtest.h>

#include "month_builder.hpp"

namespace recald::metering::close_month_test {
namespace {

using std::chrono::seconds;
using testing::kBlank;
using testing::kHour;
using testing::kQuarter;
using testing::month;
using testing::month_reading;
using testing::utc;

// Constant loads with single peaks are the easiest to compute by hand, so the checks that doubt
// them are off; validation_test has those.
ClosedMonth close(MonthSlots slots, Meter meter = {}) {
  meter.interval = slots.grid->interval();
  meter.stuck_max = seconds{0};
  ClosingOptions options;
  options.validation.spike_rise = 1e9;
  options.validation.unrated_range_factor = 1e9;
  return close_month(0, std::move(slots), meter, {}, options);
}

int count(const MonthlyFigure& figure, Validity validity) {
  return figure.slots_by_validity[static_cast<std::size_t>(validity)];
}

TEST(CloseMonth, WorkedExampleToTheDigits) {
  const ClosedMonth closed = close(month_reading("UTC", month(2015, 9), kQuarter, [](int slot) {
    const int day = slot / 96 + 1;
    if (slot % 96 != 40) return 10.0;
    return day == 5 || day == 6 ? kBlank : 20.0 + day % 3;
  }));
  const MonthlyFigure& figure = closed.figure;
  EXPECT_NEAR(figure.daily_average_kWh * 30.0, 7282.5, 1e-9);
  EXPECT_NEAR(figure.daily_average_kWh, 242.75, 1e-11);
  EXPECT_NEAR(std::sqrt(figure.daily_average_variance_kWh2), 0.009960, 5e-7);
  EXPECT_NEAR(figure.coverage, 0.999306, 5e-7);
  EXPECT_EQ(figure.slots, 2880);
  EXPECT_EQ(count(figure, Validity::ok), 2878);
  EXPECT_EQ(count(figure, Validity::filled), 2);
  ASSERT_TRUE(figure.peak.has_value());
  EXPECT_EQ(figure.peak->kW, 22.0);
  EXPECT_EQ(figure.peak->start, utc(2015, 9, 2, 10));
  EXPECT_TRUE(figure.peak->could_be_exceeded);
  EXPECT_TRUE(figure.usable) << figure.unusable_because;
}

// 1 kW for a month is as many kWh as it has hours: 743 in a London March, 745 in October; the
// days that divide them are calendar days.
TEST(CloseMonth, ClockChangesCountTheirTrueHours) {
  for (const auto& [number, hours] : {std::pair{3u, 743.0}, std::pair{10u, 745.0}}) {
    for (const seconds interval : {kQuarter, seconds{1800}, kHour}) {
      const ClosedMonth closed = close(
          month_reading("Europe/London", month(2016, number), interval, [](int) { return 1.0; }));
      EXPECT_NEAR(closed.figure.daily_average_kWh, hours / 31.0, 1e-12);
      EXPECT_EQ(closed.figure.coverage, 1.0);
    }
  }
}

TEST(CloseMonth, LeapFebruaryIsDividedBy29) {
  const ClosedMonth closed =
      close(month_reading("America/Chicago", month(2016, 2), kQuarter, [](int) { return 3.0; }));
  EXPECT_NEAR(closed.figure.daily_average_kWh, 72.0, 1e-12);
  EXPECT_EQ(closed.figure.slots, 2784);
}

TEST(CloseMonth, AThinMonthIsUnusableAndSaysWhy) {
  const ClosedMonth closed = close(month_reading(
      "UTC", month(2015, 9), kQuarter, [](int slot) { return slot % 2 == 0 ? 5.0 : kBlank; }));
  EXPECT_FALSE(closed.figure.usable);
  EXPECT_EQ(closed.figure.unusable_because,
            "only 50 % of the month's intervals are measured, 60 % are needed");
  EXPECT_NEAR(closed.figure.daily_average_kWh, 120.0, 1e-9);
}

TEST(CloseMonth, AGapOfMoreThanAWeekIsUnusableAndSaysWhere) {
  const ClosedMonth closed = close(month_reading("UTC", month(2015, 9), kQuarter, [](int slot) {
    return slot >= 5 * 96 && slot < 12 * 96 + 48 ? kBlank : 5.0;
  }));
  EXPECT_FALSE(closed.figure.usable);
  EXPECT_EQ(closed.figure.unusable_because,
            "no measurement for 7.5 days from 2015-09-06T00:00:00Z, 7 days at most");
  const ClosedMonth week = close(month_reading("UTC", month(2015, 9), kQuarter, [](int slot) {
    return slot >= 5 * 96 && slot < 12 * 96 ? kBlank : 5.0;
  }));
  EXPECT_TRUE(week.figure.usable);
}

TEST(CloseMonth, AMonthWithoutDataIsUnusableAndHasNoNumber) {
  const ClosedMonth closed =
      close(month_reading("UTC", month(2015, 9), kQuarter, [](int) { return kBlank; }));
  EXPECT_FALSE(closed.figure.usable);
  EXPECT_EQ(closed.figure.unusable_because, "no readings in this month");
  EXPECT_TRUE(std::isnan(closed.figure.daily_average_kWh));
  EXPECT_FALSE(closed.figure.peak.has_value());
  EXPECT_EQ(closed.figure.coverage, 0.0);
}

// A record that begins on the 13th covers 18 of 30 days, and says so rather than averaging them.
TEST(CloseMonth, AMonthCutByTheRecordCountsItsWholeLength) {
  const ClosedMonth closed = close(month_reading(
      "UTC", month(2015, 9), kHour, [](int slot) { return slot < 12 * 24 ? kBlank : 5.0; }));
  EXPECT_NEAR(closed.figure.coverage, 0.6, 1e-12);
  EXPECT_FALSE(closed.figure.usable);
}

TEST(CloseMonth, PeakIsNeverAFilledScaledOrSuspectSlot) {
  MonthSlots slots = month_reading("UTC", month(2015, 9), kQuarter, [](int slot) {
    if (slot % 96 == 50) return slot == 50 ? kBlank : 90.0;  // estimated 90
    if (slot == 1000) return 500.0;                          // scaled below
    if (slot == 1100) return 5000.0;                         // above the rating
    return slot == 2000 ? 95.0 : 10.0 + slot % 7;
  });
  slots.validity[1000] = Validity::scaled;
  Meter meter;
  meter.rated_kW = 200.0;
  const ClosedMonth closed = close(std::move(slots), meter);
  ASSERT_TRUE(closed.figure.peak.has_value());
  EXPECT_EQ(closed.figure.peak->kW, 95.0);
  EXPECT_EQ(count(closed.figure, Validity::suspect), 1);
  EXPECT_NEAR(closed.figure.filled_share, 3.0 / 2880.0, 1e-12);
}

TEST(CloseMonth, HourlyPeakFromQuartersTakesWholeCompleteHours) {
  MonthSlots slots = month_reading("UTC", month(2015, 9), kQuarter, [](int slot) {
    if (slot >= 398 && slot < 402) return 100.0;  // straddles an hour: 200/4 on each side
    if (slot >= 800 && slot < 804) return slot == 803 ? kBlank : 300.0;  // incomplete
    if (slot >= 1200 && slot < 1204) return 60.0;
    return 0.0;
  });
  Meter meter;
  meter.peak.window = kHour;
  const ClosedMonth closed = close(std::move(slots), meter);
  ASSERT_TRUE(closed.figure.peak.has_value());
  EXPECT_EQ(closed.figure.peak->kW, 60.0);
  EXPECT_EQ(closed.figure.peak->start, utc(2015, 9, 13, 12));
  EXPECT_EQ(closed.figure.peak_window, kHour);
}

// At half-hour zones the local hour starts half past the hour of UTC.
TEST(CloseMonth, BlocksFollowTheLocalHour) {
  MonthSlots slots = month_reading("Asia/Kolkata", month(2015, 9), kQuarter,
                                   [](int slot) { return slot >= 400 && slot < 404 ? 50.0 : 1.0; });
  Meter meter;
  meter.peak.window = kHour;
  const ClosedMonth closed = close(std::move(slots), meter);
  EXPECT_EQ(closed.figure.peak->kW, 50.0);
  EXPECT_EQ(closed.figure.peak->start, utc(2015, 9, 4, 22, 30));
}

// Helsinki jumps from 03:00 to 04:00: the two hours from 02:00 on are one hour and then another.
TEST(CloseMonth, NoBlockSpansAClockChange) {
  MonthSlots slots =
      month_reading("Europe/Helsinki", month(2016, 3), kQuarter, [](int) { return 1.0; });
  for (int slot = 0; slot < slots.slots(); ++slot) {
    const int hour = slots.grid->time_of_day(slot) / 4;
    if (slots.grid->day(slot) == 26 && (hour == 2 || hour == 4)) {
      slots.measured_kW[static_cast<std::size_t>(slot)] = 9.0;
    }
  }
  const auto peak = find_peak(slots, {PeakMethod::block, 2 * kHour});
  ASSERT_TRUE(peak.has_value());
  EXPECT_EQ(peak->kW, 5.0);  // 04:00 to 06:00
}

TEST(CloseMonth, AWindowThatDoesNotFitIsTheInterval) {
  MonthSlots slots =
      month_reading("UTC", month(2015, 9), kHour, [](int slot) { return slot == 7 ? 4.0 : 1.0; });
  Meter meter;
  meter.peak.window = kQuarter;
  const ClosedMonth closed = close(std::move(slots), meter);
  EXPECT_EQ(closed.figure.peak->kW, 4.0);
  EXPECT_EQ(closed.figure.peak_window, kHour);
}

TEST(CloseMonth, ShareOfSuspectsStandsInTheWords) {
  Meter meter;
  meter.zero_run_max = std::chrono::hours{2};
  const ClosedMonth closed =
      close(month_reading("UTC", month(2015, 9), kHour,
                          [](int slot) { return slot >= 240 ? 0.0 : 5.0 + slot % 5; }),
            meter);
  EXPECT_EQ(
      closed.figure.unusable_because,
      "only 33 % of the month's intervals are measured, 60 % are needed (480 suspect: zero_run)");
}

}  // namespace
}  // namespace recald::metering::close_month_test
