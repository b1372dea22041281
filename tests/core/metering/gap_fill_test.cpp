#include "core/metering/months/gap_fill.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random/rng.hpp"
#include "month_builder.hpp"

namespace recald::metering::gap_fill_test {
namespace {

using testing::kBlank;
using testing::kHour;
using testing::kQuarter;
using testing::month;
using testing::month_reading;

// September 2015 in UTC has 30 plain days. 10 kW but for slot 40, which reads 20 + (day mod 3) kW
// and is absent on days 5 and 6. By hand: n = 28, mean 21, s² = (10·1 + 8·0 + 10·1 …)/27.
MonthSlots worked_example() {
  return month_reading("UTC", month(2015, 9), kQuarter, [](int slot) {
    const int day = slot / 96 + 1;
    if (slot % 96 != 40) return 10.0;
    return day == 5 || day == 6 ? kBlank : 20.0 + day % 3;
  });
}

TEST(GapFill, WorkedExampleToTheDigits) {
  MonthSlots slots = worked_example();
  const FillResult result = fill_gaps(slots, {});
  EXPECT_EQ(result.filled, 2);
  const std::size_t day5 = 4 * 96 + 40;
  EXPECT_NEAR(slots.used_kW[day5], 21.0, 1e-12);
  EXPECT_EQ(slots.validity[day5], Validity::filled);
  EXPECT_EQ(slots.method[day5], FillMethod::same_time);
  EXPECT_NEAR(result.variance_kWh2, 0.089286, 5e-7);
}

TEST(GapFill, AWholeMonthIsLeftAlone) {
  MonthSlots slots =
      month_reading("UTC", month(2015, 9), kQuarter, [](int slot) { return slot * 0.5; });
  const FillResult result = fill_gaps(slots, {});
  EXPECT_EQ(result.filled, 0);
  EXPECT_EQ(result.variance_kWh2, 0.0);
  EXPECT_EQ(slots.used_kW, slots.measured_kW);
}

TEST(GapFill, NothingIsInventedFromNothing) {
  MonthSlots slots = month_reading("UTC", month(2015, 9), kQuarter, [](int) { return kBlank; });
  const FillResult result = fill_gaps(slots, {});
  EXPECT_EQ(result.filled, 0);
  EXPECT_EQ(slots.validity[0], Validity::missing);
  EXPECT_TRUE(std::isnan(slots.used_kW[0]));
}

// Slot 40 is there on two days only: the mean over slots 39, 40 and 41 of all days takes over.
TEST(GapFill, FewDaysAskTheNeighbouringTimes) {
  MonthSlots slots = month_reading("UTC", month(2015, 9), kQuarter, [](int slot) {
    const int day = slot / 96 + 1;
    const int k = slot % 96;
    if (k == 40) return day <= 2 ? 30.0 : kBlank;
    return k == 39 ? 12.0 : k == 41 ? 18.0 : 5.0;
  });
  (void)fill_gaps(slots, {});
  const std::size_t day10 = 9 * 96 + 40;
  EXPECT_EQ(slots.method[day10], FillMethod::neighbouring_times);
  EXPECT_NEAR(slots.used_kW[day10], (30 * 12.0 + 30 * 18.0 + 2 * 30.0) / 62.0, 1e-12);
}

TEST(GapFill, TimesNeverMeasuredTakeTheMonthsMean) {
  MonthSlots slots = month_reading("UTC", month(2015, 9), kQuarter, [](int slot) {
    const int k = slot % 96;
    return k >= 30 && k < 40 ? kBlank : k < 48 ? 4.0 : 8.0;
  });
  (void)fill_gaps(slots, {});
  const double mean_kW = (38 * 4.0 + 48 * 8.0) / 86.0;
  EXPECT_EQ(slots.method[35], FillMethod::month_mean);
  EXPECT_NEAR(slots.used_kW[35], mean_kW, 1e-12);
  EXPECT_EQ(slots.method[30], FillMethod::neighbouring_times);  // 29 is measured
}

// 2015-09-05 is a Saturday. Working days read 20 kW, others 8 kW.
TEST(GapFill, DayTypesAreKeptApartOnRequest) {
  const auto reading = [](int slot) {
    const int day = slot / 24 + 1;
    if (day == 7 || day == 12 || day == 9) return kBlank;  // Monday, Saturday, Wednesday
    const bool weekend = day % 7 == 5 || day % 7 == 6;
    return weekend ? 8.0 : 20.0;
  };
  FillOptions options;
  options.daytype = true;
  options.holidays = {month(2015, 9) / 9};
  MonthSlots slots = month_reading("UTC", month(2015, 9), kHour, reading);
  (void)fill_gaps(slots, options);
  EXPECT_NEAR(slots.used_kW[6 * 24 + 12], 20.0, 1e-12);
  EXPECT_NEAR(slots.used_kW[11 * 24 + 12], 8.0, 1e-12);
  EXPECT_NEAR(slots.used_kW[8 * 24 + 12], 8.0, 1e-12);  // a holiday is no working day
  EXPECT_EQ(slots.method[6 * 24], FillMethod::same_time_like_days);

  MonthSlots plain = month_reading("UTC", month(2015, 9), kHour, reading);
  (void)fill_gaps(plain, {});
  EXPECT_NEAR(plain.used_kW[6 * 24 + 12], (20 * 20.0 + 7 * 8.0) / 27.0, 1e-12);
}

TEST(GapFill, AShortGapMayBeALine) {
  const auto reading = [](int slot) {
    if (slot >= 100 && slot < 104) return kBlank;  // an hour
    if (slot >= 200 && slot < 220) return kBlank;  // five hours
    return slot < 102 ? 10.0 : 20.0;
  };
  FillOptions options;
  options.rule = FillRule::linear_short;
  MonthSlots slots = month_reading("UTC", month(2015, 9), kQuarter, reading);
  const FillResult result = fill_gaps(slots, options);
  EXPECT_NEAR(slots.used_kW[100], 12.0, 1e-12);
  EXPECT_NEAR(slots.used_kW[103], 18.0, 1e-12);
  EXPECT_EQ(slots.method[100], FillMethod::line);
  EXPECT_EQ(slots.method[200], FillMethod::same_time);
  EXPECT_GT(result.variance_kWh2, 0.0);
}

// Days are 24 kW·(1 + day mod 2) constant, one whole day and six hours missing. Slots of a day
// move together, so the variance is that of whole days: s² of 28 complete days' means, D = 1.25.
TEST(GapFill, LongGapsUseWholeDays) {
  const auto level_kW = [](int day) { return day % 2 == 0 ? 10.0 : 20.0; };
  MonthSlots slots = month_reading("UTC", month(2015, 9), kQuarter, [&](int slot) {
    const int day = slot / 96 + 1;
    const bool missing = day == 11 || (day == 12 && slot % 96 < 24);
    return missing ? kBlank : level_kW(day);
  });
  const FillResult result = fill_gaps(slots, {});
  // Of the 28 complete days 14 read 10 kW and 14 read 20 kW: s² = 28·25/27.
  const double variance_kW2 = 28.0 * 25.0 / 27.0;
  EXPECT_NEAR(result.variance_kWh2, variance_kW2 * (1.25 + 1.25 * 1.25 / 28.0) * 24.0 * 24.0, 1e-9);
}

// The same 120 slots missing one by one err independently and far less than as one long gap.
TEST(GapFill, ALongGapIsLessCertainThanScatteredOnes) {
  const auto level_kW = [](int day) { return day % 2 == 0 ? 10.0 : 20.0; };
  MonthSlots scattered = month_reading("UTC", month(2015, 9), kQuarter, [&](int slot) {
    return slot % 24 == 5 ? kBlank : level_kW(slot / 96 + 1);
  });
  MonthSlots block = month_reading("UTC", month(2015, 9), kQuarter, [&](int slot) {
    return slot >= 960 && slot < 1080 ? kBlank : level_kW(slot / 96 + 1);
  });
  const FillResult a = fill_gaps(scattered, {});
  const FillResult b = fill_gaps(block, {});
  EXPECT_EQ(a.filled, b.filled);
  EXPECT_GT(b.variance_kWh2, 2.0 * a.variance_kWh2);
}

// Gaps of an hour to most of a day in loads whose deviations last for hours: what a fill is off by
// is what it says, over many of them.
TEST(GapFill, TheVarianceIsThatOfTheErrors) {
  Rng rng{21};
  double squared = 0.0;
  int far = 0;
  constexpr int kDraws = 400;
  for (int draw = 0; draw < kDraws; ++draw) {
    const int length = 1 + static_cast<int>(rng.below(20));
    const int begin = 24 * 3 + static_cast<int>(rng.below(24 * 24));
    double deviation = 0.0;
    double missing_kWh = 0.0;
    MonthSlots slots = month_reading("UTC", month(2015, 9), kHour, [&](int slot) {
      deviation = 0.9 * deviation + rng.uniform(-1.0, 1.0);  // lasts for some ten hours
      const double load_kW = 20.0 + (slot % 24 > 7 ? 10.0 : 0.0) + deviation;
      if (slot < begin || slot >= begin + length) return load_kW;
      missing_kWh += load_kW;
      return kBlank;
    });
    const FillResult result = fill_gaps(slots, {});
    double filled_kWh = 0.0;
    for (int slot = begin; slot < begin + length; ++slot) {
      filled_kWh += slots.used_kW[static_cast<std::size_t>(slot)];
    }
    const double score = (filled_kWh - missing_kWh) / std::sqrt(result.variance_kWh2);
    squared += score * score;
    if (std::abs(score) > 2.0) ++far;
  }
  EXPECT_NEAR(std::sqrt(squared / kDraws), 0.9, 0.2);  // fully correlated is a little too much
  EXPECT_LT(far, kDraws / 15);
}

TEST(GapFill, SuspectSlotsKeepTheirValueBesideTheEstimate) {
  MonthSlots slots = month_reading("UTC", month(2015, 9), kQuarter,
                                   [](int slot) { return slot == 500 ? -900.0 : 10.0; });
  slots.validity[500] = Validity::suspect;
  const FillResult result = fill_gaps(slots, {});
  EXPECT_EQ(result.filled, 1);
  EXPECT_EQ(slots.validity[500], Validity::suspect);
  EXPECT_EQ(slots.measured_kW[500], -900.0);
  EXPECT_EQ(slots.used_kW[500], 10.0);
}

TEST(GapFill, ScaledSlotsCountAsTheyAreButTeachNothing) {
  MonthSlots slots = month_reading("UTC", month(2015, 9), kQuarter, [](int slot) {
    return slot == 500 ? 400.0 : slot == 500 + 96 ? kBlank : 10.0;
  });
  slots.validity[500] = Validity::scaled;
  (void)fill_gaps(slots, {});
  EXPECT_EQ(slots.used_kW[500], 400.0);
  EXPECT_EQ(slots.used_kW[500 + 96], 10.0);
}

}  // namespace
}  // namespace recald::metering::gap_fill_test
