#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/simulators/effects/hand_made_year.hpp"

namespace recald::simulators {

EffectKind chiller_part_load();
EffectKind fouling();
EffectKind seasonal_hot_water();
EffectKind steam_trap_leak();
EffectKind heat_pump_defrost();

}  // namespace recald::simulators

namespace recald::simulators::plant_effects_test {
namespace {

using namespace hand_made;
using namespace std::chrono_literals;

double wasted_W(HiddenEffect& effect, double cooling_W) {
  const Outdoors outdoors{};
  Untouched untouched;
  untouched.load.cooling_W = cooling_W;
  return step_of(effect, moment_at(sys_days{day_of(2022, 5, 2)}, outdoors), untouched)
      .load.other_electricity_W;
}

// Drawings: 900 kW of cooling at COP 5.2 is 173.1 kW of electricity at full load.
TEST(ChillerPartLoad, WastesMostAtTheLowestLoadAndNothingWhenOff) {
  const auto effect = make(chiller_part_load(), 0.2);
  EXPECT_EQ(wasted_W(*effect, 0.03 * 900e3), 0.0) << "too little to start";
  EXPECT_NEAR(wasted_W(*effect, 0.05 * 900e3), 0.2 * 0.95 * 900e3 / 5.2, 1e-6);
  EXPECT_NEAR(wasted_W(*effect, 0.02 * 900e3), 0.2 * 0.98 * 900e3 / 5.2, 1e-6) << "still on";
  EXPECT_NEAR(wasted_W(*effect, 0.5 * 900e3), 0.2 * 0.5 * 900e3 / 5.2, 1e-6);
  EXPECT_NEAR(wasted_W(*effect, 1.1 * 900e3), 0.0, 1e-6);
  EXPECT_EQ(wasted_W(*effect, 0.01 * 900e3), 0.0) << "off";
}

std::vector<double> chiller_factors(double strength, std::uint64_t seed, int days) {
  EffectSettings settings;
  settings.strength = strength;
  settings.rng = Rng{seed, 1};
  const auto effect = fouling().make(settings, {});
  std::vector<double> factors;
  run(*effect, day_of(2021, 1, 1), days, 24h,
      [&](const Step& step) { factors.push_back(step.operation.plant.chiller_cop_factor); });
  return factors;
}

TEST(Fouling, DriftsWorseAndJumpsBackInSpringOfMostYears) {
  int cleanings = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<double> factors = chiller_factors(0.3, seed, 4 * 365);
    for (std::size_t day = 1; day < factors.size(); ++day) {
      if (factors[day] <= factors[day - 1]) continue;
      ++cleanings;
      EXPECT_EQ(factors[day], 1.0);
      EXPECT_GE(day % 365, 31U + 28U);
      EXPECT_LE(day % 365, 31U + 28U + 75U);
    }
    EXPECT_GT(*std::ranges::min_element(factors), 1.0 / (1.0 + 0.3 * 1.61));
  }
  // 80 years of which a quarter passes without: 60, give or take 2 · sqrt(80 · 3/16).
  EXPECT_NEAR(cleanings, 60, 8);
}

TEST(Fouling, TakesTheStatedShareMoreAYearAfterCleaning) {
  const std::vector<double> factors = chiller_factors(0.3, 3, 4 * 365);
  const auto clean = std::ranges::find(factors, 1.0);
  ASSERT_GT(std::distance(clean, factors.end()), 340);
  // The next cleaning may come some weeks early or late: compare eleven months after.
  EXPECT_NEAR(1.0 / clean[330] - 1.0, 0.3 * 330.0 / 365.0, 0.03);
}

// Drawings: 6 m³ a day from 17 to 55 degC are 11.05 kW on average.
TEST(SeasonalHotWater, IsDoubledAtOneAndColdestInLateWinter) {
  const auto effect = make(seasonal_hot_water(), 1.0);
  double coldest_K = 0.0;
  int coldest_day = 0;
  int day = 0;
  run(*effect, day_of(2022, 1, 1), 365, 24h, [&](const Step& step) {
    const PlantOperation& plant = step.operation.plant;
    EXPECT_DOUBLE_EQ(plant.hot_water_factor, 2.0);
    EXPECT_NEAR(plant.heating_standing_W, 0.3 * 11'046.0, 1.0);
    if (plant.mains_shift_K < coldest_K) {
      coldest_K = plant.mains_shift_K;
      coldest_day = day;
    }
    ++day;
  });
  EXPECT_GE(coldest_day, 35);
  EXPECT_LE(coldest_day, 65);
  EXPECT_LT(coldest_K, -5.0 * 0.63);
  EXPECT_GT(coldest_K, -8.0 * 0.64);
}

TEST(SteamTrapLeak, LosesItsShareOfTheCapacityInEverySeason) {
  const auto effect = make(steam_trap_leak(), 0.04);  // of 700 kW: 28 kW
  double sum_W = 0.0;
  double least_W = 28e3;
  double most_W = 28e3;
  run(*effect, day_of(2022, 1, 1), 365, 6h, [&](const Step& step) {
    const double leak_W = step.operation.plant.heating_standing_W;
    least_W = std::min(least_W, leak_W);
    most_W = std::max(most_W, leak_W);
    sum_W += leak_W;
  });
  EXPECT_NEAR(sum_W / (4.0 * 365.0), 28e3, 0.05 * 28e3);
  // Pressure wanders by 8 % (one standard deviation), within 30 %.
  EXPECT_GT(most_W - least_W, 0.16 * 28e3);
  EXPECT_GE(least_W, 0.7 * 28e3 - 1e-6);
  EXPECT_LE(most_W, 1.3 * 28e3 + 1e-6);
}

/// Mean of 1/factor − 1 over a day at these conditions.
double defrost_penalty(double air_C, double humidity, double heating_W, std::chrono::seconds step) {
  const auto effect = make(heat_pump_defrost(), 1.0);
  Outdoors outdoors{};
  outdoors.air = air_at(air_C, humidity);
  outdoors.pressure_Pa = kSeaLevel_Pa;
  Untouched untouched;
  untouched.load.heating_W = heating_W;
  const sys_days date{day_of(2022, 1, 10)};
  double sum = 0.0;
  int steps = 0;
  for (std::chrono::seconds into{0}; into < 5 * 24h; into += step, ++steps) {
    const Moment now = moment_at(date + into, outdoors, static_cast<double>(step.count()));
    const Step done = step_of(*effect, now, untouched);
    sum += 1.0 / done.operation.plant.heat_pump_cop_factor - 1.0;
  }
  return sum / steps;
}

TEST(HeatPumpDefrost, IsWorstInFogNearFreezing) {
  EXPECT_NEAR(defrost_penalty(3.0, 1.0, 100e3, 300s), 1.0, 0.15);
  EXPECT_LT(defrost_penalty(3.0, 0.6, 100e3, 300s), 0.5 * defrost_penalty(3.0, 1.0, 100e3, 300s));
  EXPECT_LT(defrost_penalty(-12.0, 0.9, 100e3, 300s), 0.4);
  EXPECT_EQ(defrost_penalty(7.5, 1.0, 100e3, 300s), 0.0) << "the coil stays above freezing";
  EXPECT_EQ(defrost_penalty(3.0, 1.0, 0.0, 300s), 0.0) << "nothing to heat";
}

TEST(HeatPumpDefrost, HardlyDependsOnTheStep) {
  const double fine = defrost_penalty(1.0, 0.95, 100e3, 300s);
  EXPECT_NEAR(defrost_penalty(1.0, 0.95, 100e3, 900s), fine, 0.2 * fine);
}

}  // namespace
}  // namespace recald::simulators::plant_effects_test
