#include "core/metering/months/validation.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "month_builder.hpp"

namespace recald::metering::validation_test {
namespace {

using std::chrono::hours;
using std::chrono::seconds;
using testing::kBlank;
using testing::kHour;
using testing::kQuarter;
using testing::month;
using testing::month_reading;

// A lively but ordinary hourly load: 20 to 50 kW, never the same twice in a row.
double ordinary_kW(int slot) { return 20.0 + slot % 24 + 0.25 * (slot % 7); }

template <class Value>
MonthSlots hourly(Value value) {
  return month_reading("UTC", month(2015, 9), kHour, value);
}

Meter hourly_meter() {
  Meter meter;
  meter.interval = kHour;
  return meter;
}

int suspects(const MonthSlots& slots) {
  return static_cast<int>(
      std::count(slots.validity.begin(), slots.validity.end(), Validity::suspect));
}

TEST(Validation, AnOrdinaryMonthPasses) {
  MonthSlots slots = hourly(ordinary_kW);
  validate(slots, hourly_meter(), {}, {});
  EXPECT_EQ(suspects(slots), 0);
}

TEST(Validation, RangeIsOneAndAFifthOfTheRating) {
  Meter meter = hourly_meter();
  meter.rated_kW = 100.0;
  MonthSlots slots = hourly([](int slot) {
    // Four high hours a day keep the spike rule quiet.
    return slot / 24 == 3 && slot % 24 < 4 ? 119.0 + slot % 24 : ordinary_kW(slot);
  });
  validate(slots, meter, {}, {});
  EXPECT_EQ(suspects(slots), 2);  // 121 and 122 kW
  EXPECT_EQ(slots.reasons[3 * 24 + 2], Reason::range);
  EXPECT_EQ(slots.measured_kW[3 * 24 + 2], 121.0);  // kept
}

TEST(Validation, OneReadingIsDoubtedByTheRatingAndTheSignAlone) {
  Meter meter = hourly_meter();
  EXPECT_EQ(doubt_of(1e9, meter, {}), Reason::none);
  EXPECT_EQ(doubt_of(-1.0, meter, {}), Reason::negative);
  meter.rated_kW = 100.0;
  EXPECT_EQ(doubt_of(119.0, meter, {}), Reason::none);
  EXPECT_EQ(doubt_of(121.0, meter, {}), Reason::range);
  EXPECT_EQ(doubt_of(kBlank, meter, {}), Reason::none);
  meter.negative_is_valid = true;
  EXPECT_EQ(doubt_of(-119.0, meter, {}), Reason::none);
  EXPECT_EQ(doubt_of(-121.0, meter, {}), Reason::range);
}

// Without a rating a factor of 1000 (a unit slip for a whole day) stands out from the month itself.
TEST(Validation, WithoutARatingTheMonthIsItsOwnMeasure) {
  MonthSlots slots =
      hourly([](int slot) { return ordinary_kW(slot) * (slot / 24 == 3 ? 1000.0 : 1.0); });
  validate(slots, hourly_meter(), {}, {});
  EXPECT_EQ(suspects(slots), 24);
  EXPECT_EQ(slots.reasons[3 * 24], Reason::range);
}

// The first cold days after a month of standby are no error: earlier winters reached 300 kW.
TEST(Validation, HistoryExcusesTheFirstColdWeek) {
  const auto standby_then_cold = [](int slot) {
    return slot >= 600 ? 200.0 + slot % 24 : 1.0 + 0.1 * (slot % 24);
  };
  MonthSlots slots = hourly(standby_then_cold);
  validate(slots, hourly_meter(), {nullptr, nullptr, 300.0}, {});
  EXPECT_EQ(suspects(slots), 0);
  MonthSlots unknown = hourly(standby_then_cold);
  validate(unknown, hourly_meter(), {}, {});
  EXPECT_EQ(suspects(unknown), 120);
}

TEST(Validation, NegativeOnlyWhereTheMeterCannotRunBackwards) {
  const auto dip = [](int slot) { return slot == 100 ? -3.0 : ordinary_kW(slot); };
  MonthSlots slots = hourly(dip);
  validate(slots, hourly_meter(), {}, {});
  EXPECT_EQ(suspects(slots), 1);
  EXPECT_EQ(slots.reasons[100], Reason::negative);
  Meter both_ways = hourly_meter();
  both_ways.negative_is_valid = true;
  MonthSlots chilled = hourly(dip);
  validate(chilled, both_ways, {}, {});
  EXPECT_EQ(suspects(chilled), 0);
}

// A register set back by 5000 kWh at 10:00 and caught up at 13:00, as gas meters show on the first
// Mondays of winter. The large hours go, the ordinary ones between them stay.
TEST(Validation, ARegisterCorrectionIsFlaggedOnBothSides) {
  MonthSlots slots = hourly([](int slot) {
    if (slot == 106) return -5000.0;
    if (slot == 108) return 60.0;  // 10 kW above the highest hour elsewhere: part of it
    if (slot == 109) return 4800.0;
    return ordinary_kW(slot);
  });
  Meter meter = hourly_meter();
  meter.rated_kW = 1e6;  // so that the range check alone finds nothing
  ValidationOptions options;
  options.spike_rise = 1e9;
  validate(slots, meter, {}, options);
  EXPECT_EQ(slots.reasons[106], Reason::negative);
  EXPECT_EQ(slots.reasons[108], Reason::range);
  EXPECT_EQ(slots.reasons[109], Reason::range);
  EXPECT_EQ(suspects(slots), 3);
}

TEST(Validation, ACorrectionReachesOverTheMonthsEnd) {
  MonthSlots slots = hourly([](int slot) { return slot == 2 ? 4800.0 : ordinary_kW(slot); });
  const MonthSlots before = month_reading("UTC", month(2015, 8), kHour, [](int slot) {
    return slot == 743 ? -5000.0 : ordinary_kW(slot);
  });
  Meter meter = hourly_meter();
  meter.rated_kW = 1e6;
  ValidationOptions options;
  options.spike_rise = 1e9;
  validate(slots, meter, {&before, nullptr, {}}, options);
  EXPECT_EQ(suspects(slots), 1);
  EXPECT_EQ(slots.validity[2], Validity::suspect);
}

TEST(Validation, ASpikeNeedsBothConditions) {
  // 200 kW at 03:00, where every other day reads about 23 kW.
  MonthSlots spike = hourly([](int slot) { return slot == 243 ? 200.0 : ordinary_kW(slot); });
  validate(spike, hourly_meter(), {}, {});
  EXPECT_EQ(suspects(spike), 1);
  EXPECT_EQ(spike.reasons[243], Reason::spike);
  // The same 200 kW every third day at 03:00 is how this load is: robust scales see no spike.
  MonthSlots habit = hourly(
      [](int slot) { return slot % 24 == 3 ? 20.0 + 90.0 * (slot / 24 % 3) : ordinary_kW(slot); });
  validate(habit, hourly_meter(), {}, {});
  EXPECT_EQ(suspects(habit), 0);
  // 100 kW is less than 2.8 times the day's third highest hour.
  MonthSlots high = hourly([](int slot) { return slot == 243 ? 100.0 : ordinary_kW(slot); });
  validate(high, hourly_meter(), {}, {});
  EXPECT_EQ(suspects(high), 0);
}

TEST(Validation, TwoSpikesOfOneDayAreBothFound) {
  MonthSlots slots = hourly(
      [](int slot) { return slot == 243 || slot == 247 ? 300.0 + slot : ordinary_kW(slot); });
  validate(slots, hourly_meter(), {}, {});
  EXPECT_EQ(suspects(slots), 2);
}

TEST(Validation, TwelveEqualReadingsAreAFrozenMeter) {
  for (const int run : {11, 12}) {
    MonthSlots slots =
        hourly([&](int slot) { return slot >= 50 && slot < 50 + run ? 33.3 : ordinary_kW(slot); });
    validate(slots, hourly_meter(), {}, {});
    EXPECT_EQ(suspects(slots), run == 12 ? 12 : 0);
  }
  Meter unchecked = hourly_meter();
  unchecked.stuck_max = seconds{0};
  MonthSlots constant = hourly([](int) { return 5.0; });
  validate(constant, unchecked, {}, {});
  EXPECT_EQ(suspects(constant), 0);
}

TEST(Validation, BlanksNeitherBreakARunNorCountInIt) {
  MonthSlots slots = hourly([](int slot) {
    if (slot >= 50 && slot < 64) return slot == 55 || slot == 56 ? kBlank : 33.3;
    return ordinary_kW(slot);
  });
  validate(slots, hourly_meter(), {}, {});
  EXPECT_EQ(suspects(slots), 12);
  EXPECT_EQ(slots.validity[55], Validity::missing);
}

TEST(Validation, ZeroRunsLongerThanAllowedAreNoLoad) {
  const auto outage = [](int length) {
    return hourly(
        [=](int slot) { return slot >= 50 && slot < 50 + length ? 0.0 : ordinary_kW(slot); });
  };
  Meter meter = hourly_meter();
  meter.zero_run_max = hours{2};
  MonthSlots two = outage(2);
  validate(two, meter, {}, {});
  EXPECT_EQ(suspects(two), 0);
  MonthSlots three = outage(3);
  validate(three, meter, {}, {});
  EXPECT_EQ(suspects(three), 3);
  EXPECT_EQ(three.reasons[51], Reason::zero_run);
  MonthSlots gas = outage(200);  // a boiler may rest for a summer
  validate(gas, hourly_meter(), {}, {});
  EXPECT_EQ(suspects(gas), 0);
}

// Two hours of zeros before midnight and two after are four: the month's end hides nothing.
TEST(Validation, RunsContinueOverMonthEndsOnBothSides) {
  Meter meter = hourly_meter();
  meter.zero_run_max = hours{2};
  MonthSlots september =
      hourly([](int slot) { return slot < 2 || slot >= 718 ? 0.0 : ordinary_kW(slot); });
  MonthSlots alone = september;
  validate(alone, meter, {}, {});
  EXPECT_EQ(suspects(alone), 0);
  const MonthSlots august = month_reading(
      "UTC", month(2015, 8), kHour, [](int slot) { return slot >= 742 ? 0.0 : ordinary_kW(slot); });
  const MonthSlots october = month_reading("UTC", month(2015, 10), kHour, [](int slot) {
    return slot < 1 ? 0.0 : slot < 48 ? ordinary_kW(slot) : kBlank;
  });
  validate(september, meter, {&august, &october, {}}, {});
  EXPECT_EQ(suspects(september), 4);
}

// A house whose car is charged now and then: eleven kilowatts beside a few hundred watts.
TEST(Validation, ALargeLoadIsBelievedOnceItRepeats) {
  for (const int times : {1, 2, 8}) {
    for (const int length : {1, 2, 4}) {
      SCOPED_TRACE(times * 10 + length);
      MonthSlots slots = hourly([&](int slot) {
        const int day = slot / 24;
        const bool charges =
            day % 3 == 1 && day / 3 < times && slot % 24 >= 20 && slot % 24 < 20 + length;
        return charges ? 10.6 + 0.1 * (day % 4) : 0.2 + 0.01 * (slot % 24);
      });
      validate(slots, hourly_meter(), {}, {});
      // Single hours on two days are spikes still: that takes a third.
      const bool is_doubted = times == 1 || (times == 2 && length == 1);
      EXPECT_EQ(suspects(slots), is_doubted ? times * length : 0);
    }
  }
}

// What a roof feeds in at noon beside what a house draws: of a meter both ways it is a load, too.
TEST(Validation, ALargeFeedInIsBelievedOnceItRepeats) {
  Meter meter = hourly_meter();
  meter.negative_is_valid = true;
  for (const int days : {1, 3, 30}) {
    SCOPED_TRACE(days);
    MonthSlots slots = hourly([&](int slot) {
      const int hour = slot % 24;
      const bool is_sunny = slot / 24 < days && hour > 9 && hour < 15;
      return is_sunny ? -8.0 - 0.3 * hour - 0.01 * (slot / 24) : 0.06 + 0.001 * hour;
    });
    validate(slots, meter, {}, {});
    EXPECT_EQ(suspects(slots), days == 1 ? 5 : 0);
  }
}

// … also on the day before the month began.
TEST(Validation, ALargeLoadRepeatsAcrossMonths) {
  const auto charged_on = [](int day) {
    return [day](int slot) {
      return slot / 24 == day && slot % 24 >= 20 ? 11.0 + 0.1 * (day % 3)
                                                 : 0.2 + 0.01 * (slot % 24);
    };
  };
  MonthSlots september = month_reading("UTC", month(2015, 9), kHour, charged_on(2));
  const MonthSlots august = month_reading("UTC", month(2015, 8), kHour, charged_on(28));
  validate(september, hourly_meter(), {&august, nullptr, {}}, {});
  EXPECT_EQ(suspects(september), 0);
}

// A device's word for "no value" and a file that changes its unit for days repeat as well.
TEST(Validation, RepeatedWordsAndSlipsOfUnitsAreNoLoad) {
  MonthSlots words = hourly(
      [](int slot) { return slot % 24 == 7 && slot / 24 % 4 == 0 ? 6553.5 : ordinary_kW(slot); });
  validate(words, hourly_meter(), {}, {});
  EXPECT_EQ(suspects(words), 8);
  MonthSlots slips = hourly([](int slot) {
    return ordinary_kW(slot) * (slot / 24 == 3 || slot / 24 == 9 ? 1000.0 : 1.0);
  });
  validate(slips, hourly_meter(), {}, {});
  EXPECT_EQ(suspects(slips), 48);
}

TEST(Validation, WhatTheSourceSaidIsLeftAlone) {
  MonthSlots slots = hourly([](int) { return 7.0; });
  std::fill(slots.validity.begin(), slots.validity.end(), Validity::scaled);
  validate(slots, hourly_meter(), {}, {});
  EXPECT_EQ(suspects(slots), 0);
}

}  // namespace
}  // namespace recald::metering::validation_test
