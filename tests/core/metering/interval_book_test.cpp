#include "core/metering/registers/interval_book.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "month_builder.hpp"

namespace recald::metering::interval_book_test {
namespace {

using std::chrono::minutes;
using std::chrono::seconds;
using testing::kHour;
using testing::kQuarter;
using testing::utc;

const Instant kStart = utc(2016, 3, 1);

// 400 kW rated: at most 8.2 kWh a minute with r = 0.1 kWh; wraps at a million.
constexpr CounterSettings kSettings{400.0, 0.1, 1e6};

std::vector<RegisterSample> hourly_register(int count, double step_kWh) {
  std::vector<RegisterSample> samples;
  for (int i = 0; i < count; ++i) samples.push_back({kStart + i * kHour, 100.0 + i * step_kWh});
  return samples;
}

TEST(CounterReadings, SamplesOnTheGridAreItsIntervals) {
  const auto readings = readings_from_register(3, hourly_register(25, 50.0), kHour, kSettings);
  ASSERT_EQ(readings.size(), 24u);
  for (const Reading& reading : readings) {
    EXPECT_EQ(reading.meter, 3u);
    EXPECT_NEAR(reading.mean_kW, 50.0, 1e-9);
    EXPECT_EQ(reading.validity, Validity::ok);
  }
  EXPECT_EQ(readings[0].start, kStart);
}

TEST(CounterReadings, AHoleIsSpreadAndItsSumIsTrue) {
  auto samples = hourly_register(25, 50.0);
  samples.erase(samples.begin() + 5, samples.begin() + 9);
  samples[3].value_kWh = testing::kBlank;
  const auto readings = readings_from_register(0, samples, kHour, kSettings);
  ASSERT_EQ(readings.size(), 24u);
  double sum_kWh = 0.0;
  for (const Reading& reading : readings) sum_kWh += reading.mean_kW;
  EXPECT_NEAR(sum_kWh, 24 * 50.0, 1e-9);
  EXPECT_EQ(readings[1].validity, Validity::ok);
  EXPECT_EQ(readings[2].validity, Validity::scaled);
  EXPECT_EQ(readings[6].validity, Validity::scaled);
  EXPECT_EQ(readings[9].validity, Validity::ok);
}

TEST(CounterReadings, AResetLeavesItsIntervalMissing) {
  auto samples = hourly_register(25, 50.0);
  for (std::size_t i = 10; i < samples.size(); ++i) samples[i].value_kWh -= 590.0;
  const auto readings = readings_from_register(0, samples, kHour, kSettings);
  EXPECT_EQ(readings[9].validity, Validity::missing);
  EXPECT_TRUE(has(readings[9].reasons, Reason::reset));
  EXPECT_TRUE(std::isnan(readings[9].mean_kW));
  EXPECT_NEAR(readings[8].mean_kW, 50.0, 1e-9);
  EXPECT_NEAR(readings[12].mean_kW, 50.0, 1e-9);
}

// Five-minute samples that miss the boundary by two minutes: the register there is interpolated.
TEST(CounterReadings, BoundariesBetweenSamplesAreInterpolated) {
  std::vector<RegisterSample> samples;
  for (int i = 0; i < 40; ++i) {
    samples.push_back({kStart + minutes{2 + 5 * i}, 100.0 + 5.0 * i});  // 60 kW
  }
  const auto readings = readings_from_register(0, samples, kQuarter, kSettings);
  ASSERT_FALSE(readings.empty());
  EXPECT_EQ(readings.front().start, kStart + minutes{15});
  for (const Reading& reading : readings) {
    EXPECT_NEAR(reading.mean_kW, 60.0, 1e-9);
    EXPECT_EQ(reading.validity, Validity::ok);
  }
}

/// A live register: polled every minute, two poll periods bridge a hole.
struct LiveRegister {
  CounterStep step;
  IntervalBook book;
  LoadShape shape;
  BookingRules rules{.interval = kQuarter, .sample_gap_max = seconds{120}};
  CounterSettings settings = kSettings;
  std::map<Instant, Reading> intervals;  ///< As a store would keep them.
  double booked_kWh = 0.0;               ///< By the counter.

  void read(seconds after, double value_kWh) {
    step = advance(std::move(step.state), {kStart + after, value_kWh}, settings);
    for (const CounterBooking& booking : step.bookings) {
      if (!std::isnan(booking.energy_kWh)) booked_kWh += booking.energy_kWh;
    }
    for (const BookedInterval& booked : book_intervals(book, 0, step, rules, shape)) {
      const bool is_new = !intervals.contains(booked.reading.start);
      EXPECT_TRUE(is_new || booked.supersedes);
      intervals[booked.reading.start] = booked.reading;
    }
  }
  void read(int minute, double value_kWh) { read(minutes{minute}, value_kWh); }

  [[nodiscard]] const Reading& quarter(int number) const {
    return intervals.at(kStart + number * kQuarter);
  }
  [[nodiscard]] double sum_kWh() const {
    double sum = 0.0;
    for (const auto& [start, reading] : intervals) {
      if (!std::isnan(reading.mean_kW)) sum += reading.mean_kW * 0.25;
    }
    return sum;
  }
  [[nodiscard]] double open_kWh() const {
    double sum = 0.0;
    for (const CounterBooking& piece : book.pieces) {
      if (piece.span.begin >= *book.next) sum += piece.energy_kWh;
    }
    return sum;
  }
};

TEST(LiveRegister, IntervalsComeWhenTheyAreComplete) {
  LiveRegister meter;
  for (int minute = 0; minute <= 29; ++minute) meter.read(minute, 1000.0 + minute);
  EXPECT_EQ(meter.intervals.size(), 1u);
  meter.read(30, 1030.0);
  ASSERT_EQ(meter.intervals.size(), 2u);
  EXPECT_DOUBLE_EQ(meter.quarter(1).mean_kW, 60.0);
  EXPECT_EQ(meter.quarter(1).validity, Validity::ok);
  EXPECT_TRUE(meter.book.pieces.empty());
}

TEST(LiveRegister, TheIntervalOfTheFirstSampleIsNotHandedOut) {
  LiveRegister meter;
  for (int minute = 7; minute <= 30; ++minute) meter.read(minute, 1000.0 + minute);
  ASSERT_EQ(meter.intervals.size(), 1u);
  EXPECT_EQ(meter.intervals.begin()->first, kStart + kQuarter);
}

// Reads missed in the middle of an interval leave its energy exact; a missed boundary does not.
TEST(LiveRegister, OnlyAHoleAcrossABoundaryIsAnEstimate) {
  LiveRegister meter;
  for (int minute = 0; minute <= 60; ++minute) {
    const bool inside = minute > 2 && minute < 12;
    const bool across = minute > 40 && minute < 48;
    if (!inside && !across) meter.read(minute, 1000.0 + minute);
  }
  EXPECT_EQ(meter.quarter(0).validity, Validity::ok);
  EXPECT_EQ(meter.quarter(1).validity, Validity::ok);
  EXPECT_EQ(meter.quarter(2).validity, Validity::scaled);
  EXPECT_EQ(meter.quarter(3).validity, Validity::scaled);
  EXPECT_DOUBLE_EQ(meter.sum_kWh(), 60.0);
}

TEST(LiveRegister, SamplesOnEitherSideOfABoundaryAreInterpolated) {
  LiveRegister meter;
  for (int s = 20; s <= 3620; s += 60) meter.read(seconds{s}, 1000.0 + s / 60.0);
  for (int quarter = 1; quarter < 4; ++quarter) {
    EXPECT_EQ(meter.quarter(quarter).validity, Validity::ok);
    EXPECT_NEAR(meter.quarter(quarter).mean_kW, 60.0, 1e-9);
  }
}

TEST(LiveRegister, AHoleFollowsTheShapeAndKeepsItsSum) {
  LiveRegister meter;
  // Ten times as much in the second of four quarters as in the others.
  meter.shape = [](Instant t) { return t == kStart + kQuarter ? 100.0 : 10.0; };
  meter.read(0, 1000.0);
  meter.read(60, 1130.0);
  EXPECT_NEAR(meter.quarter(0).mean_kW, 40.0, 1e-9);
  EXPECT_NEAR(meter.quarter(1).mean_kW, 400.0, 1e-9);
  EXPECT_NEAR(meter.sum_kWh(), 130.0, 1e-9);
  for (const auto& [start, reading] : meter.intervals) {
    EXPECT_EQ(reading.validity, Validity::scaled);
  }
}

TEST(LiveRegister, AShapeOfNothingIsNoShape) {
  LiveRegister meter;
  meter.shape = [](Instant) { return 0.0; };
  meter.read(0, 1000.0);
  meter.read(30, 1030.0);
  EXPECT_DOUBLE_EQ(meter.quarter(0).mean_kW, 60.0);
  meter.shape = [](Instant) { return std::numeric_limits<double>::quiet_NaN(); };
  meter.read(60, 1060.0);
  EXPECT_DOUBLE_EQ(meter.quarter(3).mean_kW, 60.0);
}

TEST(LiveRegister, AResetLeavesTheIntervalsItTouchesMissing) {
  LiveRegister meter;
  for (int minute = 0; minute <= 60; ++minute) {
    meter.read(minute, minute <= 20 ? 1000.0 + minute : minute - 20.0);
  }
  EXPECT_EQ(meter.quarter(0).validity, Validity::ok);
  EXPECT_EQ(meter.quarter(1).validity, Validity::missing);
  EXPECT_TRUE(has(meter.quarter(1).reasons, Reason::reset));
  EXPECT_TRUE(std::isnan(meter.quarter(1).mean_kW));
  EXPECT_EQ(meter.quarter(2).validity, Validity::ok);
  EXPECT_NEAR(meter.quarter(2).mean_kW, 60.0, 1e-9);
}

TEST(LiveRegister, AnExchangedMeterLeavesItsHoleMissing) {
  LiveRegister meter;
  for (int minute = 0; minute <= 20; ++minute) meter.read(minute, 1000.0 + minute);
  meter.step = swap_meter(std::move(meter.step.state));
  for (int minute = 50; minute <= 75; ++minute) meter.read(minute, 5.0 + minute);
  EXPECT_EQ(meter.quarter(0).validity, Validity::ok);
  for (int quarter = 1; quarter <= 3; ++quarter) {
    EXPECT_EQ(meter.quarter(quarter).validity, Validity::missing) << quarter;
  }
  EXPECT_NEAR(meter.quarter(4).mean_kW, 60.0, 1e-9);
}

// A gateway serves 900 kWh too little for half an hour, long enough to be believed; then the
// old line is back. What was booked since is put right, the interval begun before it included.
TEST(LiveRegister, TheOldLinePutsRightWhatWasBookedSince) {
  LiveRegister meter;
  for (int minute = 0; minute <= 90; ++minute) {
    const bool wrong = minute >= 20 && minute < 50;
    meter.read(minute, 1000.0 + minute - (wrong ? 900.0 : 0.0));
  }
  ASSERT_EQ(meter.intervals.size(), 6u);
  for (int quarter = 0; quarter < 6; ++quarter) {
    EXPECT_NE(meter.quarter(quarter).validity, Validity::missing) << quarter;
    EXPECT_NEAR(meter.quarter(quarter).mean_kW, 60.0, 1e-9) << quarter;
  }
  EXPECT_EQ(meter.quarter(2).validity, Validity::scaled);
  EXPECT_EQ(meter.quarter(4).validity, Validity::ok);
  EXPECT_NEAR(meter.sum_kWh(), 90.0, 1e-9);
}

// Whatever is missed, nothing is lost: intervals and the open rest add up to what the register rose
// by since the first boundary after the first sample.
TEST(LiveRegister, SumsAreThoseOfTheRegisterThroughAnySilence) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random{seed};
    const auto chance = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    LiveRegister meter;
    meter.shape = [](Instant t) {
      const double hour = static_cast<double>(t.time_since_epoch().count() % 86'400) / 3600.0;
      return 50.0 + 40.0 * std::sin(hour * std::numbers::pi / 12.0);
    };
    double value_kWh = 999'900.0;  // rolls over on the way
    double rise_kWh = 0.0;
    seconds t{0};
    while (t < std::chrono::hours{96}) {
      meter.read(t, std::fmod(value_kWh, 1e6));
      const bool silence = chance() < 0.01;
      const seconds wait{silence ? 600 + static_cast<int>(chance() * 40'000) : 60};
      const double used_kWh = chance() * 300.0 * static_cast<double>(wait.count()) / 3600.0;
      value_kWh += used_kWh;
      rise_kWh += used_kWh;
      t += wait;
    }
    meter.read(t, std::fmod(value_kWh, 1e6));
    EXPECT_NEAR(meter.booked_kWh, rise_kWh, 1e-6);
    EXPECT_NEAR(meter.sum_kWh() + meter.open_kWh(), rise_kWh, 1e-6);
    EXPECT_EQ(meter.intervals.size(), static_cast<std::size_t>(t / kQuarter));
    EXPECT_LE(meter.book.pieces.size(), 16u);
  }
}

}  // namespace
}  // namespace recald::metering::interval_book_test
