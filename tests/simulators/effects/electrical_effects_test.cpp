#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "tests/simulators/effects/hand_made_year.hpp"

namespace recald::simulators {

EffectKind plug_growth();
EffectKind equipment_step();
EffectKind server_room();
EffectKind exterior_lighting();
EffectKind demand_limit();

}  // namespace recald::simulators

namespace recald::simulators::electrical_effects_test {
namespace {

using namespace hand_made;
using namespace std::chrono_literals;

constexpr double kFloor_m2 = 7800.0;  // of the drawings

double plugs_factor_after_years(double strength, int years, std::uint64_t seed) {
  EffectSettings settings;
  settings.strength = strength;
  settings.rng = Rng{seed, 1};
  const auto effect = plug_growth().make(settings, {});
  double factor = 0.0;
  double before = 1.0;
  run(*effect, day_of(2021, 1, 1), 365 * years, 24h, [&](const Step& step) {
    factor = step.operation.rooms.plugs_factor;
    EXPECT_TRUE(strength > 0.0 ? factor > before : factor < before) << "never turns back";
    before = factor;
  });
  return factor;
}

TEST(PlugGrowth, ReachesItsYearlyShareOnAverage) {
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sum += std::log(plugs_factor_after_years(0.12, 3, seed)) / 20.0;
  }
  EXPECT_NEAR(sum, 3.0 * std::log(1.12), 0.015);
  EXPECT_LT(plugs_factor_after_years(-0.12, 3, 1), 0.75);
  EXPECT_GT(plugs_factor_after_years(-0.12, 3, 1), 0.60);
}

TEST(EquipmentStep, ComesInOverDaysAndRunsMoreWhilePeopleAreThere) {
  const auto effect =
      make(equipment_step(), 3.0, {}, between(day_of(2022, 5, 2), day_of(2022, 12, 31)));
  double night_W = 0.0;
  double noon_W = 0.0;
  double first_W = -1.0;
  run(*effect, day_of(2022, 4, 25), 40, 6h, [&](const Step& step) {
    const double extra_W = step.operation.rooms.extra_plugs_W;
    const bool before = step.now.local.date < day_of(2022, 5, 2);
    EXPECT_TRUE(before == (extra_W == 0.0)) << metering::to_string(step.now.instant);
    if (!before && first_W < 0.0) first_W = extra_W;
    (step.now.hour() == 12.0 && step.now.people_share > 0.0 ? noon_W : night_W) = extra_W;
  });
  EXPECT_LT(first_W, 0.5 * night_W);
  EXPECT_NEAR(night_W, 0.55 * 3.0 * kFloor_m2, 1e-6);
  EXPECT_NEAR(noon_W, (0.55 + 0.45 * 0.8) * 3.0 * kFloor_m2, 1e-6);
}

// Installed lamps of the drawings: perimeter 1116 m² · 9.5, core 1038.8 m² · 10.5, special
// 445.2 m² · 10.5 W/m² make 10.07 W/m² on average.
TEST(EquipmentStep, BetterLampsTakeTheirShareOfTheLights) {
  const auto effect = make(equipment_step(), -3.0);
  double factor = 1.0;
  run(*effect, day_of(2022, 5, 2), 30, 24h, [&](const Step& step) {
    factor = step.operation.rooms.lights_factor;
    EXPECT_EQ(step.operation.rooms.extra_plugs_W, 0.0);
  });
  EXPECT_NEAR(factor, 1.0 - 3.0 / 10.07, 1e-3);
}

TEST(ServerRoom, RunsAtAllHoursAndHardlyVaries) {
  const auto effect = make(server_room(), 2.0);
  double sum = 0.0;
  double squares = 0.0;
  run(*effect, day_of(2022, 1, 1), 365, 6h, [&](const Step& step) {
    const double against_mean = step.operation.rooms.server_W / (2.0 * kFloor_m2) - 1.0;
    EXPECT_LT(std::abs(against_mean), 0.16);
    sum += against_mean / (4.0 * 365.0);
    squares += against_mean * against_mean / (4.0 * 365.0);
  });
  EXPECT_NEAR(sum, 0.0, 0.03);
  EXPECT_NEAR(std::sqrt(squares), 0.04, 0.015);
}

TEST(ExteriorLighting, BurnsFromDuskToDawn) {
  const auto effect = make(exterior_lighting(), 1.5);
  double june_h = 0.0;
  double december_h = 0.0;
  double midnights_W = 0.0;
  run(*effect, day_of(2022, 1, 1), 365, 300s, [&](const Step& step) {
    const double lamps_W = step.load.other_electricity_W;
    midnights_W += step.now.hour() == 0.0 ? lamps_W / 365.0 : 0.0;
    const double elevation_deg = step.now.outdoors.sun.elevation_deg();
    if (elevation_deg > 2.0) {
      EXPECT_EQ(lamps_W, 0.0);
    }
    if (elevation_deg < 0.0) {
      EXPECT_NEAR(lamps_W, 0.95 * 1.5 * kFloor_m2, 0.11 * 1.5 * kFloor_m2);
    }
    if (step.now.local.date == day_of(2022, 6, 21)) june_h += lamps_W > 0.0 ? 1.0 / 12.0 : 0.0;
    if (step.now.local.date == day_of(2022, 12, 21)) {
      december_h += lamps_W > 0.0 ? 1.0 / 12.0 : 0.0;
    }
  });
  EXPECT_NEAR(midnights_W, 0.95 * 1.5 * kFloor_m2, 0.015 * 1.5 * kFloor_m2) << "a few are broken";
  // Nights at 40 degrees north last 9.0 and 14.7 h between sunset and sunrise.
  EXPECT_NEAR(june_h, 9.1, 0.5);
  EXPECT_NEAR(december_h, 14.8, 0.5);
}

/// A building with a demand of its own that does as it is told.
struct LimitedDay {
  std::vector<double> demand_kW;
  std::vector<double> cooling_C;
  std::vector<double> plugs_factor;
};

/// A mild fortnight in which the controller learns, then one afternoon at this temperature.
LimitedDay limited_day(double strength, double afternoon_C) {
  const auto effect = make(demand_limit(), strength);
  LimitedDay day;
  Outdoors outdoors{};
  for (int i = 0; i < 15; ++i) {
    for (int minute = 0; minute < 1440; minute += 5) {
      const bool last = i == 14;
      outdoors.air.temperature_C = last ? afternoon_C : 15.0;
      const double hour = minute / 60.0;
      const double uncut_kW = 150.0 + (hour > 8.0 && hour < 18.0 ? (last ? 150.0 : 140.0) : 0.0);
      const metering::Instant t =
          sys_days{day_of(2022, 6, 6)} + std::chrono::days{i} + std::chrono::minutes{minute};
      Moment now = moment_at(t, outdoors, 300.0);
      now.day_kind = DayKind::workday;
      Operation operation = Untouched{}.operation;
      effect->operate(now, operation);
      const double share = 0.5 * operation.rooms.lights_factor + 0.5 * operation.rooms.plugs_factor;
      UtilityPower power{uncut_kW * share, 0.0, 0.0};
      effect->supply(now, power);
      if (!last) continue;
      day.demand_kW.push_back(power.electricity_kW);
      day.cooling_C.push_back(operation.rooms.cooling_C);
      day.plugs_factor.push_back(operation.rooms.plugs_factor);
    }
  }
  return day;
}

double afternoon_mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (std::size_t step = 13 * 12; step < 17 * 12; ++step) sum += values[step] / 48.0;
  return sum;
}

TEST(DemandLimit, HoldsHotAfternoonsDownAndLetsRoomsWarmUp) {
  const LimitedDay day = limited_day(0.15, 33.0);
  EXPECT_LT(afternoon_mean(day.demand_kW), 0.92 * 300.0);
  EXPECT_GT(afternoon_mean(day.demand_kW), 0.70 * 300.0);
  EXPECT_GT(afternoon_mean(day.cooling_C), 24.5);
  EXPECT_EQ(day.cooling_C[10 * 12], 24.0) << "in the morning";
}

TEST(DemandLimit, CatchesUpInTheEvening) {
  const LimitedDay day = limited_day(0.15, 33.0);
  double missed = 0.0;
  double caught_up = 0.0;
  for (const double factor : day.plugs_factor) {
    missed += std::max(0.0, 1.0 - factor);
    caught_up += std::max(0.0, factor - 1.0);
  }
  EXPECT_GT(missed, 1.0);
  EXPECT_NEAR(caught_up, missed, 0.05 * missed);
  EXPECT_GT(day.plugs_factor[19 * 12], 1.0);
}

TEST(DemandLimit, LeavesMildAfternoonsAlone) {
  EXPECT_EQ(afternoon_mean(limited_day(0.15, 20.0).demand_kW), 300.0);
}

TEST(DemandLimit, GrowsFromNothingWithTheCap) {
  double before_kW = 300.0;
  for (const double strength : {0.002, 0.01, 0.03, 0.06}) {
    const double mean_kW = afternoon_mean(limited_day(strength, 33.0).demand_kW);
    EXPECT_LT(mean_kW, before_kW) << strength;
    before_kW = mean_kW;
  }
  EXPECT_GT(afternoon_mean(limited_day(0.0005, 33.0).demand_kW), 0.99 * 300.0);
}

}  // namespace
}  // namespace recald::simulators::electrical_effects_test
