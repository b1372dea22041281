/// A counter held against a power.
#include "core/metering/registers/power_check.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace recald::metering::power_check_test {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};
constexpr std::chrono::seconds kQuarter{900};
constexpr PowerCheckRules kRules{.rated_kW = 400.0, .resolution_kWh = 0.1};

/// Interval after interval, as the counter and the power have them.
struct Watched {
  PowerCheck check;
  PowerCheckRules rules = kRules;
  int number = 0;
  std::vector<Reading> frozen;
  int announced = 0;
  std::vector<double> ratios;

  void take(double counted_kW, double powered_kW, Validity counted = Validity::ok,
            Validity powered = Validity::ok) {
    const Instant start = kStart + number++ * kQuarter;
    const PowerVerdict verdict = check_power(check, {1, start, counted_kW, counted},
                                             {1, start, powered_kW, powered}, kQuarter, rules);
    frozen.insert(frozen.end(), verdict.frozen.begin(), verdict.frozen.end());
    announced += verdict.has_frozen_now ? 1 : 0;
    if (verdict.power_to_counter != 0.0) ratios.push_back(verdict.power_to_counter);
  }
  void run(int intervals, double counted_kW, double powered_kW) {
    for (int i = 0; i < intervals; ++i) take(counted_kW, powered_kW);
  }
};

TEST(PowerCheck, ACounterThatStandsUnderLoadIsFrozen) {
  Watched meter;
  meter.run(2, 60.0, 60.0);
  meter.run(3, 0.0, 60.0);
  EXPECT_THAT(meter.frozen, IsEmpty()) << "three intervals may be a coarse register";
  meter.run(3, 0.0, 60.0);
  ASSERT_THAT(meter.frozen, SizeIs(6));
  EXPECT_EQ(meter.announced, 1) << "once a run";
  for (int i = 0; i < 6; ++i) {
    const Reading& reading = meter.frozen[static_cast<std::size_t>(i)];
    EXPECT_EQ(reading.start, kStart + (2 + i) * kQuarter);
    EXPECT_EQ(reading.validity, Validity::suspect);
    EXPECT_EQ(reading.reasons, Reason::stuck);
  }
  meter.run(1, 60.0, 60.0);
  meter.run(4, 0.0, 60.0);
  EXPECT_EQ(meter.announced, 2);
}

TEST(PowerCheck, AnIdleLoadOrACoarseCounterMayStand) {
  Watched idle;
  idle.run(20, 0.0, 20.0);  // 5 % of the rating, not above it
  EXPECT_THAT(idle.frozen, IsEmpty());
  Watched coarse{.rules = {.rated_kW = 400.0, .resolution_kWh = 40.0}};
  coarse.run(4, 0.0, 60.0);  // 60 kWh: less than two of its steps
  EXPECT_THAT(coarse.frozen, IsEmpty());
  coarse.run(2, 0.0, 60.0);
  EXPECT_THAT(coarse.frozen, SizeIs(6));
}

TEST(PowerCheck, WhatIsNotMeasuredEndsARun) {
  Watched meter;
  meter.run(3, 0.0, 60.0);
  meter.take(std::numeric_limits<double>::quiet_NaN(), 60.0, Validity::missing);
  meter.run(3, 0.0, 60.0);
  meter.take(0.0, std::numeric_limits<double>::quiet_NaN(), Validity::ok, Validity::missing);
  meter.run(3, 0.0, 60.0);
  EXPECT_THAT(meter.frozen, IsEmpty());
}

TEST(PowerCheck, ADaysEnergiesMayDifferByFivePerCent) {
  Watched alike;
  alike.run(96, 100.0, 104.9);
  EXPECT_THAT(alike.ratios, IsEmpty());
  Watched apart;
  apart.run(95, 100.0, 106.0);
  EXPECT_THAT(apart.ratios, IsEmpty()) << "not before a day is over";
  apart.run(1, 100.0, 106.0);
  ASSERT_THAT(apart.ratios, SizeIs(1));
  EXPECT_NEAR(apart.ratios[0], 1.06, 1e-9);
  apart.run(96, 100.0, 100.0);
  EXPECT_THAT(apart.ratios, SizeIs(1)) << "each day is judged for itself";
}

TEST(PowerCheck, AWrongUnitIsAFactor) {
  Watched meter;
  meter.run(96, 100.0, 0.1);
  ASSERT_THAT(meter.ratios, SizeIs(1));
  EXPECT_NEAR(meter.ratios[0], 0.001, 1e-9);
}

TEST(PowerCheck, ExportAndAPowerThatIsNeverThereSayNothing) {
  Watched exporting;
  exporting.run(100, 0.0, -200.0);
  EXPECT_THAT(exporting.frozen, IsEmpty());
  EXPECT_THAT(exporting.ratios, IsEmpty());
  Watched prosumer;
  prosumer.run(80, 100.0, 100.0);
  prosumer.run(16, 0.0, -50.0);
  prosumer.run(16, 100.0, 100.0);
  EXPECT_THAT(prosumer.ratios, IsEmpty());
  Watched without;
  without.run(100, 100.0, 0.0);
  EXPECT_THAT(without.ratios, IsEmpty());
}

TEST(PowerCheck, AFewStepsOfTheCounterAreNoDifference) {
  Watched meter{.rules = {.rated_kW = 400.0, .resolution_kWh = 10.0}};
  meter.run(96, 1.0, 1.5);  // 24 and 36 kWh: 12 kWh apart, two steps are 20
  EXPECT_THAT(meter.ratios, IsEmpty());
}

}  // namespace
}  // namespace recald::metering::power_check_test
