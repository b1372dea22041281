// Effects outside the catalogue: what stands on the roof, in the car park, in the cellar.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <vector>

#include "tests/simulators/effects/hand_made_year.hpp"

namespace recald::simulators {

EffectKind snow_on_skylight();
EffectKind ev_charging();
EffectKind irrigation_pumps();
EffectKind solar_panels();
EffectKind snow_melting();
EffectKind backup_generator_test();
EffectKind swimming_pool();
EffectKind data_backup_nights();

}  // namespace recald::simulators

namespace recald::simulators::site_effects_test {
namespace {

using namespace hand_made;
using namespace std::chrono_literals;

constexpr double kFloor_m2 = 7800.0;  // of the drawings

Drawings with_skylight() {
  Drawings drawings;
  drawings.skylight_share = 0.1;
  return drawings;
}

TEST(SnowOnSkylight, DarkensTheCoreWhileSnowLies) {
  const auto effect = make(snow_on_skylight(), 0.9, with_skylight());
  // 8 mm of water take 0.9 (1 − e^(−8/3)) = 0.837 of the light.
  run(*effect, day_of(2022, 1, 1), 60, 900s, [&](const Step& step) {
    const bool lies = step.now.outdoors.snow_cover_mm > 0.0;
    EXPECT_NEAR(step.operation.envelope.skylight_factor, lies ? 1.0 - 0.8375 : 1.0, 1e-4);
    const bool seen =
        lies && step.now.people_share > 0.0 && step.now.outdoors.global_horizontal_W_m2 > 0.0;
    EXPECT_EQ(step.operation.rooms.extra_lights_W > 0.0, seen);
  });
}

// 0.4 of the core's 1038.8 m² · 10.5 W/m² are 4363 W; at 50 W/m² daylight on 103.88 m² of skylight
// replaces 103.88 · 50 · 0.25 · 110/85 = 1680 W of lamps.
TEST(SnowOnSkylight, BringsBackTheLampsThatDaylightReplaced) {
  const auto effect = make(snow_on_skylight(), 1.0, with_skylight());
  Outdoors outdoors{};
  outdoors.snow_cover_mm = 1000.0;
  outdoors.global_horizontal_W_m2 = 50.0;
  const sys_days date{day_of(2022, 1, 19)};
  const Moment noon = moment_at(date + 12h, outdoors);
  EXPECT_NEAR(step_of(*effect, noon).operation.rooms.extra_lights_W, 0.8 * 1680.0, 1.0);
  outdoors.global_horizontal_W_m2 = 400.0;
  EXPECT_NEAR(step_of(*effect, noon).operation.rooms.extra_lights_W, 0.8 * 4363.0, 1.0);
}

TEST(EvCharging, HasAMorningAndAnAfternoonHumpOnWorkingDays) {
  const auto effect = make(ev_charging(), 5.0);
  std::array<double, 24> workday_W{};
  double weekend_W = 0.0;
  run(*effect, day_of(2022, 5, 2), 84, 300s, [&](const Step& step) {
    const double cars_W = step.load.other_electricity_W;
    EXPECT_LE(cars_W, 5.0 * kFloor_m2 + 1e-6);
    if (step.now.day_kind == DayKind::workday) {
      workday_W[static_cast<std::size_t>(step.now.hour())] += cars_W / (60.0 * 12.0);
    } else {
      weekend_W += cars_W / (24.0 * 288.0);
    }
  });
  EXPECT_EQ(workday_W[3], 0.0);
  EXPECT_EQ(workday_W[20], 0.0);
  EXPECT_GT(workday_W[9], 0.4 * 5.0 * kFloor_m2);
  EXPECT_LT(workday_W[12], 0.7 * workday_W[9]);
  EXPECT_GT(workday_W[14], 1.3 * workday_W[12]);
  EXPECT_LT(weekend_W, 0.04 * 5.0 * kFloor_m2);
}

TEST(EvCharging, CarriesTheSameEnergyAtAnyStep) {
  std::array<double, 2> kWh{};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto effect = make(ev_charging(), 5.0);
    run(*effect, day_of(2022, 5, 2), 14, i == 0 ? 300s : 900s, [&](const Step& step) {
      kWh[i] += step.load.other_electricity_W * step.now.step_s / 3.6e6;
    });
  }
  EXPECT_NEAR(kWh[0], kWh[1], 1e-6 * kWh[0]);
}

TEST(IrrigationPumps, RunAtNightInWarmWeeksUnlessItRains) {
  const auto effect = make(irrigation_pumps(), 3.0);
  double january_h = 0.0;
  double july_h = 0.0;
  run(*effect, day_of(2022, 1, 1), 365, 900s, [&](const Step& step) {
    const bool on = step.load.other_electricity_W > 0.0;
    EXPECT_TRUE(!on || step.now.hour() >= 22.0 || step.now.hour() < 5.0);
    if (on) {
      EXPECT_NEAR(step.load.other_electricity_W, 3.0 * kFloor_m2, 0.2 * 3.0 * kFloor_m2);
    }
    const auto month = step.now.local.date.month();
    january_h += on && month == std::chrono::January ? 0.25 : 0.0;
    july_h += on && month == std::chrono::July ? 0.25 : 0.0;
  });
  EXPECT_EQ(january_h, 0.0);
  // Some 5 mm a day less 12 mm of rain every tenth day, at 2 mm an hour: about 60 h.
  EXPECT_GT(july_h, 40.0);
  EXPECT_LT(july_h, 90.0);
}

TEST(IrrigationPumps, StayOffInAWetSummer) {
  const auto effect = make(irrigation_pumps(), 3.0);
  walk(
      day_of(2022, 7, 1), 30, 900s,
      [&](metering::Day day, Timetable& timetable) { effect->plan(day, timetable); },
      [&](const Moment& now) {
        Outdoors wet = now.outdoors;
        wet.precipitation_mm_h = 0.4;
        const Moment drizzle = moment_at(now.instant, wet);
        EXPECT_EQ(step_of(*effect, drizzle).load.other_electricity_W, 0.0);
      });
}

TEST(SolarPanels, FollowTheSunAndNeverTurnTheMeterBack) {
  const auto effect = make(solar_panels(), 20.0);  // 156 kW rated
  double june_kWh = 0.0;
  double december_kWh = 0.0;
  run(*effect, day_of(2022, 1, 1), 365, 900s, [&](const Step& step) {
    const double made_kW = 300.0 - step.power.electricity_kW;
    EXPECT_GE(made_kW, 0.0);
    EXPECT_LE(made_kW, 0.85 * 156.0 + 1e-9);
    if (step.now.outdoors.sun.elevation_deg() < 0.0) {
      EXPECT_EQ(made_kW, 0.0);
    }
    const auto month = step.now.local.date.month();
    june_kWh += month == std::chrono::June ? 0.25 * made_kW : 0.0;
    december_kWh += month == std::chrono::December ? 0.25 * made_kW : 0.0;
    EXPECT_EQ(step.power.cooling_kW, 250.0);
  });
  EXPECT_GT(june_kWh, 1.5 * december_kWh);
  // Every day clear at 40 degrees north: 5 to 8 full hours a day in June.
  EXPECT_GT(june_kWh, 30.0 * 5.0 * 156.0);
  EXPECT_LT(june_kWh, 30.0 * 8.0 * 156.0);
}

TEST(SolarPanels, ExportIsNotCounted) {
  const auto effect = make(solar_panels(), 20.0);
  const metering::Instant noon = sys_days{day_of(2022, 6, 21)} + 12h;
  const Outdoors outdoors = outdoors_at(noon);
  Untouched small;
  small.power.electricity_kW = 30.0;
  EXPECT_EQ(step_of(*effect, moment_at(noon, outdoors), small).power.electricity_kW, 0.0);
  Outdoors snowed_in = outdoors;
  snowed_in.snow_cover_mm = 200.0;
  EXPECT_NEAR(step_of(*effect, moment_at(noon, snowed_in), small).power.electricity_kW, 30.0, 1e-9);
}

// 6 W/m² · 7800 m² = 46.8 kW, three quarters of it heat.
TEST(SnowMelting, HeatsFullyInSnowGentlyInDryFrostAndDriesUp) {
  const auto effect = make(snow_melting(), 6.0);
  Outdoors outdoors{};
  metering::Instant t = sys_days{day_of(2022, 1, 3)};
  const auto heat_W_at = [&](double air_C, double precipitation_mm_h) {
    outdoors.air.temperature_C = air_C;
    outdoors.precipitation_mm_h = precipitation_mm_h;
    const Step step = step_of(*effect, moment_at(t, outdoors));
    t += kInterval;
    EXPECT_NEAR(step.load.other_electricity_W, step.operation.plant.heating_standing_W / 3.0, 1e-6);
    return step.operation.plant.heating_standing_W;
  };
  EXPECT_EQ(heat_W_at(5.0, 2.0), 0.0) << "rain";
  EXPECT_EQ(heat_W_at(1.5, 0.0), 0.0);
  EXPECT_NEAR(heat_W_at(-1.0, 0.0), 0.25 * 35'100.0, 1e-6) << "dry frost";
  EXPECT_NEAR(heat_W_at(-1.0, 1.0), 35'100.0, 1e-6) << "snowfall";
  for (int step = 0; step < 11; ++step) {
    EXPECT_NEAR(heat_W_at(3.0, 0.0), 35'100.0, 1e-6) << "puddles";
  }
  EXPECT_EQ(heat_W_at(3.0, 0.0), 0.0);
}

TEST(SnowMelting, IsAllElectricWithAHeatPump) {
  Drawings drawings;
  drawings.heating = HeatingPlant::heat_pump;
  const auto effect = make(snow_melting(), 6.0, drawings);
  Outdoors outdoors{};
  outdoors.air.temperature_C = -2.0;
  outdoors.snow_cover_mm = 10.0;
  const Step step = step_of(*effect, moment_at(sys_days{day_of(2022, 1, 3)}, outdoors));
  EXPECT_NEAR(step.load.other_electricity_W, 46'800.0, 1e-6);
  EXPECT_EQ(step.operation.plant.heating_standing_W, 0.0);
}

TEST(BackupGeneratorTest, TakesTheBuildingOffTheMeterOnceAMonth) {
  const auto effect = make(backup_generator_test(), 4.0);
  std::map<unsigned, double> hours_off;  // by month, at full share
  std::set<std::chrono::sys_days> days;
  run(*effect, day_of(2022, 1, 1), 365, 900s, [&](const Step& step) {
    const double off = 1.0 - step.power.electricity_kW / 300.0;
    if (off <= 0.0) return;
    EXPECT_EQ(step.now.day_kind, DayKind::workday);
    EXPECT_LE(off, 0.97);
    hours_off[static_cast<unsigned>(step.now.local.date.month())] += 0.25 * off;
    days.insert(sys_days{step.now.local.date});
  });
  ASSERT_EQ(hours_off.size(), 12U);
  EXPECT_EQ(days.size(), 12U);
  // Four hours with one and the same share of the building.
  for (const auto& [month, hours] : hours_off) EXPECT_NEAR(hours, hours_off[1], 1e-9) << month;
  EXPECT_GT(hours_off[1], 4.0 * 0.80);
  EXPECT_LT(hours_off[1], 4.0 * 0.97);
}

TEST(SwimmingPool, NeedsHeatInSummerTooAndMostOnMondays) {
  const auto effect = make(swimming_pool(), 12.0);  // 93.6 m²
  std::map<std::chrono::month, double> sums_W;
  run(*effect, day_of(2022, 1, 3), 364, 900s, [&](const Step& step) {
    const double heat_W = step.operation.plant.heating_standing_W;
    EXPECT_GE(heat_W, 0.0);
    EXPECT_GT(step.load.other_electricity_W, 93.6 * 18.0 - 1e-6);
    sums_W[step.now.local.date.month()] += heat_W;
  });
  EXPECT_GT(sums_W[std::chrono::July] / (31.0 * 96.0), 93.6 * 30.0);
  EXPECT_GT(sums_W[std::chrono::December], 1.2 * sums_W[std::chrono::July]);
}

// 0.06 m of 1000 kg/m³ warmed by 16 K within twelve hours take 93.0 W for each m².
TEST(SwimmingPool, WarmsNewWaterOnMondays) {
  const auto effect = make(swimming_pool(), 12.0);
  std::map<double, double> monday_W;
  std::map<double, double> tuesday_W;
  Outdoors outdoors{};
  outdoors.air = {20.0, 0.006};
  for (const auto& [day, heat_W] :
       {std::pair{day_of(2022, 7, 4), &monday_W}, std::pair{day_of(2022, 7, 5), &tuesday_W}}) {
    Timetable timetable{.kind = DayKind::workday, .air = {6.0, 20.0}};
    effect->plan(day, timetable);
    for (const auto hour : {5h, 6h, 17h, 18h}) {
      const Step step = step_of(*effect, moment_at(sys_days{day} + hour, outdoors));
      (*heat_W)[static_cast<double>(hour.count())] = step.operation.plant.heating_standing_W;
    }
  }
  EXPECT_NEAR(monday_W[6.0] - monday_W[5.0], 93.6 * 93.02, 1.0);
  EXPECT_EQ(monday_W[17.0], monday_W[6.0]);
  EXPECT_EQ(monday_W[18.0], monday_W[5.0]);
  EXPECT_EQ(tuesday_W[6.0], tuesday_W[5.0]) << "closed until seven";
  EXPECT_GT(tuesday_W[17.0], 2.0 * tuesday_W[5.0]) << "open";
}

TEST(SwimmingPool, DriesByMachineInMuggyWeather) {
  const auto effect = make(swimming_pool(), 12.0);
  Timetable timetable{.kind = DayKind::workday, .air = {6.0, 20.0}};
  effect->plan(day_of(2022, 7, 5), timetable);
  Outdoors muggy{};
  muggy.air = {30.0, 0.018};
  Outdoors dry{};
  dry.air = {30.0, 0.006};
  const metering::Instant noon = sys_days{day_of(2022, 7, 5)} + 12h;
  const Step in_muggy = step_of(*effect, moment_at(noon, muggy));
  const Step in_dry = step_of(*effect, moment_at(noon, dry));
  EXPECT_GT(in_muggy.load.other_electricity_W, 1.5 * in_dry.load.other_electricity_W);
  EXPECT_LT(in_muggy.operation.plant.heating_standing_W, in_dry.operation.plant.heating_standing_W);
}

TEST(DataBackupNights, ComputeAtTheTurnOfTheMonthUntilTheMorning) {
  const auto effect = make(data_backup_nights(), 8.0);
  std::map<std::chrono::sys_days, double> hours;  // by the day on which the night began
  run(*effect, day_of(2022, 1, 10), 81, 900s, [&](const Step& step) {
    if (step.operation.rooms.server_W <= 0.0) return;
    EXPECT_NEAR(step.operation.rooms.server_W, 0.925 * 8.0 * kFloor_m2, 0.18 * 8.0 * kFloor_m2);
    EXPECT_TRUE(step.now.hour() >= 19.5 || step.now.hour() < 9.0);
    hours[std::chrono::floor<std::chrono::days>(step.now.instant - 12h)] += 0.25;
  });
  const auto nights = [&](unsigned month, unsigned first, unsigned last) {
    for (unsigned day = first; day <= last; ++day) {
      EXPECT_GE(hours[sys_days{day_of(2022, month, day)}], 4.75) << month << "-" << day;
      EXPECT_LE(hours[sys_days{day_of(2022, month, day)}], 11.25) << month << "-" << day;
    }
  };
  nights(1, 29, 31);
  nights(2, 1, 2);
  nights(2, 26, 28);
  nights(3, 1, 2);
  nights(3, 29, 30);
  EXPECT_EQ(hours.size(), 13U) << "the last is cut at the end";
}

/// Effects whose chance must not depend on how strong they are: each step in proportion.
TEST(SiteEffects, ScaleEachStepWithTheirStrength) {
  for (const EffectKind& kind :
       {ev_charging(), irrigation_pumps(), snow_melting(), swimming_pool(), data_backup_nights()}) {
    SCOPED_TRACE(kind.id);
    std::array<std::vector<double>, 2> steps_W;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto effect = make(kind, i == 0 ? 1.0 : 3.0);
      run(*effect, day_of(2022, 1, 1), 240, 900s, [&](const Step& step) {
        steps_W[i].push_back(step.load.other_electricity_W + step.operation.rooms.server_W +
                             step.operation.plant.heating_standing_W);
      });
    }
    double sum_W = 0.0;
    for (std::size_t step = 0; step < steps_W[0].size(); ++step) {
      ASSERT_NEAR(steps_W[1][step], 3.0 * steps_W[0][step], 1e-6) << step;
      sum_W += steps_W[0][step];
    }
    EXPECT_GT(sum_W, 0.0);
  }
}

}  // namespace
}  // namespace recald::simulators::site_effects_test
