// How much outdoor air: damper_stuck_open, outdoor_air_amount, economiser_failed,
// economiser_changeover, demand_ventilation.
#include <algorithm>

#include "tests/simulators/effects/by_hand.hpp"

namespace recald::simulators {

EffectKind damper_stuck_open();
EffectKind outdoor_air_amount();
EffectKind economiser_failed();
EffectKind economiser_changeover();
EffectKind demand_ventilation();

}  // namespace recald::simulators

namespace recald::simulators::outdoor_air_test {
namespace {

TEST(DamperStuckOpen, LeaksDayAndNightNearItsStrength) {
  Bench bench(damper_stuck_open(), strength_of(0.4));
  double least = 1.0;
  double most = 0.0;
  metering::Day day = day_of(2020, 1, 1);
  for (int i = 0; i < 3 * 365; ++i, day = next(day)) {
    bench.plan(day);
    const double at_night = bench.operate(day, 3.0).air.damper_leak_share;
    EXPECT_EQ(bench.operate(day, 12.0).air.damper_leak_share, at_night);
    least = std::min(least, at_night);
    most = std::max(most, at_night);
  }
  EXPECT_GE(least, 0.85 * 0.4);
  EXPECT_LE(most, 1.15 * 0.4);
  EXPECT_GT(most - least, 0.01);  // somebody has worked on it in three years
}

TEST(DamperStuckOpen, NeverMoreThanAllOfTheAir) {
  Bench bench(damper_stuck_open(), strength_of(1.0));
  bench.plan(kMonday);
  EXPECT_LE(bench.operate(kMonday, 12.0).air.damper_leak_share, 1.0);
}

TEST(OutdoorAirAmount, MoreOrLessFromItsDateOn) {
  for (const double strength : {-0.5, 0.5}) {
    Bench bench(outdoor_air_amount(), strength_from(strength, kTuesday));
    EXPECT_EQ(bench.operate(kMonday, 12.0).air.outdoor_factor, 1.0);
    EXPECT_DOUBLE_EQ(bench.operate(kTuesday, 12.0).air.outdoor_factor, 1.0 + strength);
  }
}

TEST(EconomiserFailed, TakesItsShareOfFreeCooling) {
  Bench bench(economiser_failed(), strength_of(0.75));
  EXPECT_DOUBLE_EQ(bench.operate(kMonday, 12.0).air.economiser_share, 0.25);
  Bench all(economiser_failed(), strength_of(1.0));
  EXPECT_DOUBLE_EQ(all.operate(kMonday, 12.0).air.economiser_share, 0.0);
}

TEST(EconomiserChangeover, ShiftsEitherWay) {
  for (const double strength : {-6.0, 5.0}) {
    Bench bench(economiser_changeover(), strength_of(strength));
    EXPECT_DOUBLE_EQ(bench.operate(kMonday, 12.0).air.economiser_shift_K, strength);
  }
}

TEST(DemandVentilation, FollowsThePeopleWithTheLagOfTheRoomAir) {
  Bench bench(demand_ventilation(), strength_of(1.0));
  bench.people_share = 0.0;
  EXPECT_NEAR(bench.operate_until(kMonday, 7.0).air.outdoor_factor, 0.25, 1e-12);
  bench.people_share = 0.75;  // everybody arrives at once
  const double at_first = bench.operate(kMonday, 8.0).air.outdoor_factor;
  EXPECT_GT(at_first, 0.25);
  EXPECT_LT(at_first, 0.6);
  for (double hour = 8.25; hour < 12.0; hour += 0.25) bench.operate(kMonday, hour);
  EXPECT_NEAR(bench.operate(kMonday, 12.0).air.outdoor_factor, 1.0, 0.02);
}

TEST(DemandVentilation, ControlsOnlyItsShareOfTheAir) {
  Bench bench(demand_ventilation(), strength_of(0.4));
  EXPECT_NEAR(bench.operate(kMonday, 3.0).air.outdoor_factor, 1.0 - 0.4 * 0.75, 1e-12);
}

}  // namespace
}  // namespace recald::simulators::outdoor_air_test
