#include <gtest/gtest.h>

#include <map>

#include "simulators/effects/yearly_wave.hpp"
#include "tests/simulators/effects/hand_made_year.hpp"

namespace recald::simulators {

EffectKind wind_infiltration();
EffectKind stack_infiltration();
EffectKind solar_gain_change();
EffectKind thermal_mass();
EffectKind ground_coupling();

}  // namespace recald::simulators

namespace recald::simulators::envelope_effects_test {
namespace {

using namespace hand_made;
using namespace std::chrono_literals;

constexpr metering::Day kMonday = std::chrono::year{2022} / 5 / 2;

TEST(YearlyWave, IsLowestOnTheColdestDayAndTurnedRoundInTheSouth) {
  EXPECT_NEAR(yearly_wave(day_of(2022, 1, 21), 20.0, 40.0), -1.0, 1e-12);
  EXPECT_NEAR(yearly_wave(day_of(2022, 7, 22), 20.0, 40.0), 1.0, 1e-3);
  EXPECT_NEAR(yearly_wave(day_of(2022, 7, 22), 20.0, -40.0), -1.0, 1e-3);
}

// Drawings: 2 · (65 + 40) m · 3 · 4.2 m = 2646 m² of facade, so 1 m² for each 1000 m² is a gap of
// 2.646 m², which 2.5 gaps of an open door join.
TEST(WindInfiltration, LeaksOnOneSideMostAndOpensTheDoorForDeliveries) {
  const auto effect = make(wind_infiltration(), 1.0);
  double open_steps = 0.0;
  run(*effect, kMonday, 7, 300s, [&](const Step& step) {
    auto openings_m2 = step.operation.envelope.opening_m2;
    std::ranges::sort(openings_m2);
    EXPECT_GE(openings_m2[0], 0.05 * 2.646);
    EXPECT_LE(openings_m2[2], 0.20 * 2.646);
    const bool open = openings_m2[3] > 3.0;
    EXPECT_NEAR(openings_m2[3], open ? 3.5 * 2.646 : 2.646, 1e-9);
    EXPECT_TRUE(!open || (step.now.day_kind == DayKind::workday && step.now.hour() > 6.0 &&
                          step.now.hour() < 17.0));
    open_steps += open ? 1.0 : 0.0;
  });
  // Six deliveries of 0.35 h on five days, some at the same time: somewhat under 126 steps.
  EXPECT_GT(open_steps, 70.0);
  EXPECT_LT(open_steps, 135.0);
}

TEST(StackInfiltration, DrawsMoreWhileLandingDoorsAreWedgedOpen) {
  const auto effect = make(stack_infiltration(), 0.1);  // · 7800 m² of floor: 0.78 m²
  std::map<double, int> steps;
  run(*effect, kMonday, 28, 900s, [&](const Step& step) {
    ++steps[step.operation.envelope.shaft_m2];
    const bool work =
        step.now.day_kind == DayKind::workday && step.now.hour() > 6.0 && step.now.hour() < 19.0;
    EXPECT_TRUE(work || step.operation.envelope.shaft_m2 < 0.6);
  });
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_NEAR(steps.begin()->first, 0.75 * 0.78, 1e-12);
  EXPECT_NEAR(steps.rbegin()->first, 0.78, 1e-12);
  EXPECT_GT(steps.rbegin()->second, 200);  // about 12 days of 10 hours
}

double mean_sun_factor(double strength, metering::Day first) {
  const auto effect = make(solar_gain_change(), strength);
  double sum = 0.0;
  run(*effect, first, 30, 6h, [&](const Step& step) {
    for (const double factor : step.operation.envelope.sun_factor) {
      EXPECT_TRUE(strength < 0.0 ? factor < 1.0 && factor >= 0.0 : factor > 1.0);
      sum += factor / (4.0 * 30.0 * 4.0);
    }
    EXPECT_EQ(step.operation.envelope.skylight_factor, 1.0);
  });
  return sum;
}

TEST(SolarGainChange, ShadesMoreInLeafAndEitherWay) {
  const double summer = mean_sun_factor(-0.4, day_of(2022, 7, 1));
  const double winter = mean_sun_factor(-0.4, day_of(2022, 1, 1));
  EXPECT_LT(summer, winter);
  EXPECT_LT(winter, 1.0);
  EXPECT_LT(mean_sun_factor(-0.7, day_of(2022, 7, 1)), summer);
  EXPECT_NEAR(mean_sun_factor(0.4, day_of(2022, 7, 1)) - 1.0, 1.0 - summer, 1e-12);
}

TEST(ThermalMass, ScalesHeatCapacity) {
  Truth truth{};
  truth.mass_scale = 1.2;
  make(thermal_mass(), -0.5)->build(truth);
  EXPECT_DOUBLE_EQ(truth.mass_scale, 0.6);
  make(thermal_mass(), 1.5)->build(truth);
  EXPECT_DOUBLE_EQ(truth.mass_scale, 1.5);
}

double ground_u_W_m2K(double strength, double drawn_W_m2K) {
  Truth truth{};
  truth.ground_u_W_m2K = drawn_W_m2K;
  make(ground_coupling(), strength)->build(truth);
  return truth.ground_u_W_m2K;
}

TEST(GroundCoupling, TakesInsulationAway) {
  EXPECT_EQ(ground_u_W_m2K(0.0, 0.35), 0.35);
  EXPECT_NEAR(ground_u_W_m2K(0.5, 0.35), 1.0 / (0.5 / 0.35 + 0.5 / 0.9), 1e-12);
  EXPECT_NEAR(ground_u_W_m2K(1.0, 0.35), 0.9, 1e-12);
  EXPECT_NEAR(ground_u_W_m2K(1.0, 0.95), 0.95, 1e-12) << "there was none";
}

TEST(GroundCoupling, BringsTheSeasonsUnderTheFloorAMonthLate) {
  const auto effect = make(ground_coupling(), 0.8);
  std::map<double, int> days;  // since 1 January 2023, by shift
  int day = -365;
  run(*effect, day_of(2022, 1, 1), 730, 24h, [&](const Step& step) {
    if (day++ >= 0) days[step.operation.envelope.ground_shift_K] = day;
  });
  // Two layers of 15 days damp the air's yearly 15 K by 1 + (2π 15/365)² to 14.06 K and delay it by
  // 2 · atan(0.258) = 29 days; 0.7 · 0.8 of it reach the floor. The air is coldest on 21 January.
  EXPECT_NEAR(days.begin()->second, 20 + 29, 6);
  EXPECT_NEAR((days.rbegin()->first - days.begin()->first) / 2.0, 0.56 * 14.06, 0.1);
}

}  // namespace
}  // namespace recald::simulators::envelope_effects_test
