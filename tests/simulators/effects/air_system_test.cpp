// What the air system does to the air: simultaneous_heating_cooling, supply_reset_missing,
// constant_speed_fans, constant_flow_pumps, deep_drying, humidifier.
#include <algorithm>
#include <utility>

#include "simulators/climate/air.hpp"
#include "tests/simulators/effects/by_hand.hpp"

namespace recald::simulators {

EffectKind simultaneous_heating_cooling();
EffectKind supply_reset_missing();
EffectKind constant_speed_fans();
EffectKind constant_flow_pumps();
EffectKind deep_drying();
EffectKind humidifier();

}  // namespace recald::simulators

namespace recald::simulators::air_system_test {
namespace {

TEST(SimultaneousHeatingCooling, LeaksInSummerTooAndWandersABit) {
  Bench bench(simultaneous_heating_cooling(), strength_of(0.1));
  double sum = 0.0;
  double least = 1.0;
  double most = 0.0;
  metering::Day day = day_of(2020, 1, 1);
  constexpr int kDays = 3 * 365;
  for (int i = 0; i < kDays; ++i, day = next(day)) {
    bench.plan(day);
    const double share = bench.operate(day, 15.0).air.reheat_leak_share;
    EXPECT_GE(share, 0.07 - 1e-12);
    EXPECT_LE(share, 0.13 + 1e-12);
    sum += share;
    least = std::min(least, share);
    most = std::max(most, share);
  }
  EXPECT_NEAR(sum / kDays, 0.1, 0.01);
  EXPECT_GT(most - least, 0.02);
}

TEST(SupplyResetMissing, ColdSupplyAirInColdWeatherOnly) {
  Bench bench(supply_reset_missing(), strength_of(4.0));
  bench.outdoors.air.temperature_C = 25.0;
  EXPECT_EQ(bench.operate(kMonday, 12.0).air.supply_shift_K, 0.0);
  for (const auto& [outdoor_C, shift_K] :
       {std::pair{11.5, -1.0}, std::pair{5.0, -2.0}, std::pair{-15.0, -2.0}}) {
    Bench cold(supply_reset_missing(), strength_of(4.0));
    cold.outdoors.air.temperature_C = outdoor_C;
    const AirOperation air = cold.operate(kMonday, 12.0).air;
    EXPECT_NEAR(air.supply_shift_K, shift_K, 1e-12) << outdoor_C << " degC";
    EXPECT_EQ(air.supply_reset_share, 0.0);
  }
  Bench half(supply_reset_missing(), strength_of(1.5));
  EXPECT_DOUBLE_EQ(half.operate(kMonday, 12.0).air.supply_reset_share, 0.5);
}

TEST(ConstantSpeedFans, TakesItsShareOfTheFans) {
  Bench bench(constant_speed_fans(), strength_of(0.75));
  EXPECT_DOUBLE_EQ(bench.operate(kMonday, 12.0).air.fan_follows_flow, 0.25);
}

TEST(ConstantFlowPumps, TakesItsShareOfThePumpsDayAndNight) {
  Bench bench(constant_flow_pumps(), strength_of(0.75));
  EXPECT_DOUBLE_EQ(bench.operate(kMonday, 12.0).plant.pumps_follow_load, 0.25);
  EXPECT_DOUBLE_EQ(bench.operate(kMonday, 3.0).plant.pumps_follow_load, 0.25);
}

/// Outdoor air of this dew point.
void set_dew_point(Bench& bench, double dew_C) {
  const double pressure_Pa = bench.outdoors.pressure_Pa;
  bench.outdoors.air = {28.0, saturation_humidity_kg_kg(dew_C, pressure_Pa)};
}

TEST(DeepDrying, DriesOnHumidDaysOnly) {
  Drawings drawings;
  drawings.supply_C = 13.0;
  Bench bench(deep_drying(), strength_of(3.0), drawings);
  const auto dry_to_C = [&](double outdoor_dew_C) {
    set_dew_point(bench, outdoor_dew_C);
    return bench.operate(kMonday, 12.0).air.dry_to_C;
  };
  EXPECT_FALSE(dry_to_C(13.0).has_value());
  ASSERT_TRUE(dry_to_C(14.5).has_value());
  EXPECT_DOUBLE_EQ(*dry_to_C(14.5), 10.0);
  EXPECT_TRUE(dry_to_C(12.5).has_value());  // goes on until it is clearly dry outside
  EXPECT_FALSE(dry_to_C(11.5).has_value());
}

TEST(Humidifier, HoldsItsHumidityInTheHeatingSeason) {
  Bench bench(humidifier(), strength_of(40.0));
  bench.outdoors.air = {-2.0, 0.002};
  bench.plan(kMonday);
  // ASHRAE Handbook, Fundamentals: saturated air of 21 degC has 15.72 g/kg at sea level, of which
  // 0.4 % is the presence of air, which the simulator leaves out.
  EXPECT_NEAR(bench.operate(kMonday, 12.0).air.humidify_to_kg_kg, 0.4 * 0.01572, 3e-5);
}

TEST(Humidifier, SwitchesOffInTheWarmSeasonAndNotWithinADay) {
  Bench bench(humidifier(), strength_of(40.0));
  bench.plan(kMonday);
  bench.outdoors.air.temperature_C = 5.0;
  EXPECT_GT(bench.operate_until(kMonday, 23.0).air.humidify_to_kg_kg, 0.0);
  bench.outdoors.air.temperature_C = 25.0;
  EXPECT_GT(bench.operate_until(kTuesday, 12.0).air.humidify_to_kg_kg, 0.0);
  for (int i = 0; i < 3; ++i) bench.operate_until(kTuesday, 23.75);
  EXPECT_EQ(bench.operate(kTuesday, 12.0).air.humidify_to_kg_kg, 0.0);
}

TEST(Humidifier, StandsStillOnSomeDays) {
  Bench bench(humidifier(), strength_of(40.0));
  bench.outdoors.air.temperature_C = 0.0;
  int off = 0;
  metering::Day day = day_of(2020, 1, 1);
  for (int i = 0; i < 1000; ++i, day = next(day)) {
    bench.plan(day);
    off += bench.operate(day, 12.0).air.humidify_to_kg_kg == 0.0;
  }
  EXPECT_GT(off, 10);
  EXPECT_LT(off, 60);
}

}  // namespace
}  // namespace recald::simulators::air_system_test
