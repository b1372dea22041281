/// A power that is sampled, as intervals.
#include "core/metering/registers/power_book.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace recald::metering::power_book_test {
namespace {

using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};
constexpr seconds kQuarter{900};

/// A load sampled every 15 s but for stretches in which nobody answers.
struct Sampled {
  PowerBook book;
  PowerRules rules;
  std::vector<Reading> readings;

  void take(seconds after, double power_kW, Reason reasons = Reason::none) {
    for (const Reading& reading : book_power(book, 7, {kStart + after, power_kW}, reasons, rules)) {
      readings.push_back(reading);
    }
  }
  /// Samples of a constant load in [from, to].
  void run(seconds from, seconds to, double power_kW) {
    for (seconds t = from; t <= to; t += seconds{15}) take(t, power_kW);
  }
};

TEST(PowerBook, TheMeanIsWeighedByTime) {
  Sampled load{.rules = {.sample_gap_max = seconds{300}}};
  // Up from 0 to 60 kW in five minutes, ten minutes of 60 kW: (30 · 5 + 60 · 10) / 15.
  load.take(seconds{0}, 0.0);
  load.take(minutes{5}, 60.0);
  for (int minute = 6; minute <= 15; ++minute) load.take(minutes{minute}, 60.0);
  ASSERT_THAT(load.readings, SizeIs(1));
  EXPECT_EQ(load.readings[0].start, kStart);
  EXPECT_EQ(load.readings[0].meter, 7u);
  EXPECT_NEAR(load.readings[0].mean_kW, 50.0, 1e-9);
  EXPECT_EQ(load.readings[0].validity, Validity::ok);
  EXPECT_EQ(load.readings[0].reasons, Reason::none);
}

TEST(PowerBook, ABoundaryBetweenTwoSamplesPartsTheirLine) {
  Sampled load{.rules = {.sample_gap_max = seconds{60}}};
  load.run(seconds{0}, seconds{885}, 10.0);
  load.take(seconds{930}, 40.0);  // 20 kW at the boundary, a third of the way
  load.run(seconds{945}, seconds{1800}, 40.0);
  ASSERT_THAT(load.readings, SizeIs(2));
  EXPECT_NEAR(load.readings[0].mean_kW, (885.0 * 10.0 + 15.0 * 15.0) / 900.0, 1e-12);
  EXPECT_NEAR(load.readings[1].mean_kW, (30.0 * 30.0 + 870.0 * 40.0) / 900.0, 1e-12);
}

TEST(PowerBook, FourFifthsAreEnoughAndLessIsNot) {
  for (const int hole_s : {180, 195}) {
    Sampled load;
    load.run(seconds{0}, seconds{300}, 10.0);
    load.take(seconds{300 + hole_s}, 10.0, Reason::timeout);
    load.run(seconds{315 + hole_s}, seconds{900}, 10.0);
    ASSERT_THAT(load.readings, SizeIs(1)) << hole_s;
    const bool is_enough = hole_s == 180;
    EXPECT_EQ(load.readings[0].validity, is_enough ? Validity::ok : Validity::missing) << hole_s;
    EXPECT_EQ(std::isnan(load.readings[0].mean_kW), !is_enough);
    EXPECT_EQ(load.readings[0].reasons,
              is_enough ? Reason::timeout : Reason::timeout | Reason::partial);
  }
}

// In an hour 80 % leave room for a hole of twelve minutes; five are the most.
TEST(PowerBook, NoHoleIsLongerThanFiveMinutes) {
  for (const int hole_s : {300, 315}) {
    Sampled load{.rules = {.interval = seconds{3600}}};
    load.run(seconds{0}, seconds{600}, 10.0);
    load.run(seconds{600 + hole_s}, seconds{3600}, 10.0);
    ASSERT_THAT(load.readings, SizeIs(1));
    EXPECT_EQ(load.readings[0].validity, hole_s == 300 ? Validity::ok : Validity::missing)
        << hole_s;
  }
}

TEST(PowerBook, AHoleDoesNotPullTheMeanDown) {
  Sampled load;
  load.run(seconds{0}, seconds{300}, 10.0);
  load.run(seconds{420}, seconds{900}, 10.0);
  ASSERT_THAT(load.readings, SizeIs(1));
  EXPECT_NEAR(load.readings[0].mean_kW, 10.0, 1e-9) << "what is not measured is not zero";
}

TEST(PowerBook, ALongSilenceLeavesEveryIntervalMissing) {
  Sampled load;
  load.run(seconds{0}, seconds{900}, 10.0);
  load.take(4 * kQuarter, 20.0, Reason::exception);
  ASSERT_THAT(load.readings, SizeIs(4));
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_EQ(load.readings[i].start, kStart + static_cast<int>(i) * kQuarter);
    EXPECT_EQ(load.readings[i].validity, Validity::missing);
    EXPECT_EQ(load.readings[i].reasons, Reason::exception | Reason::partial);
  }
  load.run(4 * kQuarter, 5 * kQuarter, 20.0);
  ASSERT_THAT(load.readings, SizeIs(5));
  EXPECT_EQ(load.readings[4].reasons, Reason::none) << "the next one is whole again";
  EXPECT_NEAR(load.readings[4].mean_kW, 20.0, 1e-9);
}

TEST(PowerBook, PollsSlowerThanFiveMinutesMeasureNothing) {
  Sampled load{.rules = {.sample_gap_max = seconds{1200}}};
  for (int i = 0; i <= 4; ++i) load.take(minutes{10 * i}, 10.0);
  ASSERT_THAT(load.readings, SizeIs(2));
  EXPECT_EQ(load.readings[0].validity, Validity::missing);
}

TEST(PowerBook, TheFirstIntervalCountsIfMostOfItWasSeen) {
  Sampled early;
  early.run(seconds{120}, seconds{900}, 10.0);
  ASSERT_THAT(early.readings, SizeIs(1));
  EXPECT_EQ(early.readings[0].validity, Validity::ok);
  Sampled late;
  late.run(seconds{240}, seconds{900}, 10.0);
  ASSERT_THAT(late.readings, SizeIs(1));
  EXPECT_EQ(late.readings[0].validity, Validity::missing);
}

TEST(PowerBook, NoIntervalTwiceWhenTheClockGoesBack) {
  Sampled load;
  load.run(seconds{0}, seconds{1000}, 10.0);
  ASSERT_THAT(load.readings, SizeIs(1));
  forget_power(load.book);
  load.run(seconds{100}, seconds{990}, 99.0);
  EXPECT_THAT(load.readings, SizeIs(1)) << "what is booked is booked";
  load.run(seconds{1005}, seconds{1800}, 30.0);
  ASSERT_THAT(load.readings, SizeIs(2));
  EXPECT_EQ(load.readings[1].start, kStart + kQuarter);
}

TEST(PowerBook, ExportIsNegative) {
  Sampled load;
  load.run(seconds{0}, seconds{900}, -12.5);
  ASSERT_THAT(load.readings, SizeIs(1));
  EXPECT_NEAR(load.readings[0].mean_kW, -12.5, 1e-9);
}

// However a load is cut into samples: the sum over all intervals is its integral.
TEST(PowerBook, EnergyIsThatOfTheLine) {
  Sampled load{.rules = {.sample_gap_max = seconds{60}}};
  double expected_kWh = 0.0;
  double before_kW = 0.0;
  seconds t{0};
  for (int i = 0; t < seconds{7200}; ++i) {
    const double power_kW = 50.0 + 40.0 * std::sin(0.37 * i);
    const seconds step{i == 0 ? 0 : 7 + i % 50};
    const seconds next = std::min(t + step, seconds{7200});
    const double hours = static_cast<double>((next - t).count()) / 3600.0;
    expected_kWh += hours * (before_kW + power_kW) / 2.0;
    t = next;
    before_kW = power_kW;
    load.take(t, power_kW);
  }
  ASSERT_THAT(load.readings, SizeIs(8));
  double sum_kWh = 0.0;
  for (const Reading& reading : load.readings) sum_kWh += reading.mean_kW / 4.0;
  EXPECT_NEAR(sum_kWh, expected_kWh, 1e-9);
}

}  // namespace
}  // namespace recald::metering::power_book_test
