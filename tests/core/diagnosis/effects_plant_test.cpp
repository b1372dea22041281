// Entries of envelope, plant, electrical load and meters: what each does to one step, by hand, and
// which way it moves the three meters of a whole year.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/diagnosis/effects/support/effect.hpp"
#include "core/model/hourly/hourly.hpp"
#include "core/weather/psychrometrics.hpp"
#include "tests/support/sample_building.hpp"

namespace recald::diagnosis::effects_plant_test {
namespace {

using metering::Utility;
using model::DriverHour;
using model::hourly::Alteration;
using model::hourly::StepLoads;
using model::hourly::StepOperation;

class PlantEffects : public ::testing::Test {
 protected:
  std::unique_ptr<Alteration> bind(std::string_view id, std::vector<double> values,
                                   int meter = -1) const {
    return find_effect(id)->bind(facts_, values, meter);
  }

  /// One step's operation after the effect.
  StepOperation operated(const Alteration& effect, const DriverHour& hour,
                         StepOperation operation) const {
    effect.operate(hour, operation);
    return operation;
  }

  StepLoads supplied(const Alteration& effect, const DriverHour& hour,
                     const StepOperation& operation, StepLoads loads) const {
    effect.supply(building_, hour, operation, loads);
    return loads;
  }

  const DriverHour& hour_at(int month, int day, int local_hour) const {
    const metering::Day date{std::chrono::year{2021}, std::chrono::month(unsigned(month)),
                             std::chrono::day(unsigned(day))};
    return *std::ranges::find_if(drivers_->hours, [&](const DriverHour& hour) {
      return hour.date == date && hour.local_hour == local_hour;
    });
  }

  Eigen::ArrayXXd run(const Alteration* alteration) {
    Eigen::ArrayXXd power_kW(hourly_.step_count(), 3);
    const std::array<const Alteration*, 1> one{alteration};
    hourly_.run(building_, alteration ? std::span{one} : std::span<const Alteration* const>{},
                meters_, power_kW);
    return power_kW;
  }

  /// Of electricity, chilled water and steam; MWh a year.
  Eigen::Array3d yearly_change_MWh(std::string_view id, std::vector<double> values) {
    const auto alteration = bind(id, std::move(values));
    return (run(alteration.get()) - run(nullptr)).colwise().sum().transpose() / 1e3;
  }

  model::Building building_ = testing::sample_building();
  std::shared_ptr<const model::Drivers> drivers_ =
      std::make_shared<model::Drivers>(testing::sample_drivers(building_, 12));
  std::vector<model::MeterMap> meters_ = {*model::default_meter_map(Utility::electricity),
                                          *model::default_meter_map(Utility::chilled_water),
                                          *model::default_meter_map(Utility::steam)};
  SiteFacts facts_{.building = building_,
                   .drivers = *drivers_,
                   .utilities = {Utility::electricity, Utility::chilled_water, Utility::steam},
                   .mean_kW = {120.0, 90.0, 80.0}};
  model::hourly::Hourly hourly_{drivers_};
};

StepOperation cold_night() {
  StepOperation operation{};
  operation.dry_bulb_C = -4.0;
  operation.wind_m_s = 8.0;
  operation.solar_share = 1.0;
  operation.plugs_W = 20e3;
  operation.lights_W = 10e3;
  operation.cooling_occupied_C = 24.0;
  operation.cooling_unoccupied_C = 28.0;
  operation.heating_occupied_C = 21.0;
  operation.heating_unoccupied_C = 16.0;
  operation.infiltration_factor = 1.0;
  operation.ground_C = 16.0;
  return operation;
}

StepLoads some_loads() {
  StepLoads loads{};
  loads.plugs_W = 20e3;
  loads.fans_W = 10e3;
  loads.hot_water_W = 4e3;
  loads.hot_water_litres_share = 1.0;
  loads.cooling_cost_factor = 1.0;
  loads.heating_cost_factor = 1.0;
  return loads;
}

// --- Envelope ---

TEST_F(PlantEffects, WindRaisesLeakageByItsPower) {
  const DriverHour& hour = hour_at(1, 20, 3);
  EXPECT_NEAR(operated(*bind("wind_infiltration", {0.1, 4.0 / 3.0}), hour, cold_night())
                  .infiltration_factor,
              1.0 + 0.1 * 16.0, 1e-12);  // 8^(4/3) = 16
  EXPECT_GT(yearly_change_MWh("wind_infiltration", {0.2, 1.0})[2], 1.0);
}

TEST_F(PlantEffects, StackFollowsHeightAndDifference) {
  // 12 m high, 16 C inside: sqrt(12 * 20 / 100) = 1.549
  const auto stack = bind("stack_infiltration", {0.5});
  EXPECT_NEAR(operated(*stack, hour_at(1, 20, 3), cold_night()).infiltration_factor,
              1.0 + 0.5 * std::sqrt(2.4), 1e-12);
  StepOperation mild = cold_night();
  mild.dry_bulb_C = 20.0;
  EXPECT_EQ(operated(*stack, hour_at(1, 20, 3), mild).infiltration_factor, 1.0);
  EXPECT_GT(yearly_change_MWh("stack_infiltration", {0.5})[2], 1.0);
}

TEST_F(PlantEffects, SunIsTakenAwayAboveItsThreshold) {
  const DriverHour& noon = hour_at(6, 21, 13);
  const double above_W_m2 = noon.global_horizontal_W_m2 + 25.0;  // a quarter below full effect
  EXPECT_EQ(operated(*bind("solar_gain_change", {0.2, 0.0}), noon, cold_night()).solar_share, 0.8);
  EXPECT_NEAR(
      operated(*bind("solar_gain_change", {0.2, above_W_m2}), noon, cold_night()).solar_share,
      1.0 - 0.2 * 0.75, 1e-12);
  const Eigen::Array3d change_MWh = yearly_change_MWh("solar_gain_change", {0.3, 0.0});
  EXPECT_LT(change_MWh[1], 0.0);
  EXPECT_GT(change_MWh[2], 0.0);
}

TEST_F(PlantEffects, MassIsScaledAndMovesHoursNotTheYear) {
  model::Building heavier = building_;
  bind("thermal_mass", {2.0})->rebuild(heavier);
  EXPECT_EQ(heavier.heat_capacity_J_m2K, 330e3);

  const Eigen::ArrayXXd base_kW = run(nullptr);
  const Eigen::ArrayXXd change_kW = run(bind("thermal_mass", {2.0}).get()) - base_kW;
  EXPECT_GT(change_kW.col(2).abs().maxCoeff(), 5.0);
  EXPECT_LT(std::abs(change_kW.col(2).sum()), 0.05 * base_kW.col(2).sum());
}

TEST_F(PlantEffects, GroundIsColdestAfterTheAir) {
  const auto ground = bind("ground_coupling", {1667.0 * 0.2, 40.0});
  model::Building coupled = building_;
  ground->rebuild(coupled);
  EXPECT_NEAR(coupled.surfaces.back().u_W_m2K, 0.4, 1e-12);  // as much again as the slab has

  // The air swings by 11 K about 17 C with its trough on New Year's Eve; half of that wave, since
  // both paths weigh the same, and exp(-2 pi 40/365) of it in the ground, forty days later.
  const double trough_C = 17.0 - 11.0 * std::exp(-2.0 * std::numbers::pi * 40.0 / 365.0);
  const StepOperation after = operated(*ground, hour_at(2, 9, 0), cold_night());
  EXPECT_NEAR(after.ground_C, 0.5 * (16.0 + trough_C), 0.15);

  const Eigen::Array3d change_MWh = yearly_change_MWh("ground_coupling", {500.0, 40.0});
  EXPECT_LT(change_MWh[1], 0.0);
  EXPECT_GT(change_MWh[2], 0.0);
}

TEST_F(PlantEffects, GroundIsAddedWhereDrawingsHaveNone) {
  std::erase_if(building_.surfaces, [](const model::Surface& surface) {
    return surface.kind == model::SurfaceKind::ground;
  });
  const auto ground = bind("ground_coupling", {500.0, 40.0});
  model::Building coupled = building_;
  ground->rebuild(coupled);
  ASSERT_EQ(coupled.surfaces.size(), building_.surfaces.size() + 1);
  const model::Surface& slab = coupled.surfaces.back();
  EXPECT_NEAR(slab.u_W_m2K * slab.area_m2, 500.0, 1e-9);
}

TEST_F(PlantEffects, GroundThatIsLaidBareLaterLeavesTheTimeBeforeAsItWas) {
  constexpr double kFrom_d = 150.0;
  const Eigen::ArrayXXd none_kW = run(nullptr);
  const Eigen::ArrayXXd whole_kW = run(bind("ground_coupling", {2000.0, 40.0}).get());
  const Eigen::ArrayXXd later_kW =
      run(within_dates(bind("ground_coupling", {2000.0, 40.0}), kFrom_d, 1e9).get());
  const auto is_before = [&](const DriverHour& hour) {
    return model::elapsed_days(hour) < kFrom_d;
  };
  const auto before = std::ranges::count_if(drivers_->hours, is_before);
  EXPECT_TRUE((later_kW.topRows(before) == none_kW.topRows(before)).all());
  // Two months later the building has forgotten when it began.
  const Eigen::Index settled = later_kW.rows() - before - 60 * 24;
  ASSERT_GT(settled, 24 * 30);
  EXPECT_LT((later_kW - whole_kW).bottomRows(settled).abs().maxCoeff(), 1e-6);
  EXPECT_GT((later_kW - none_kW).bottomRows(settled).abs().maxCoeff(), 1.0);
}

/// Counts how often the building is made anew.
class Counted final : public Alteration {
 public:
  void rebuild(model::Building&) const override { ++times; }
  mutable int times = 0;
};

TEST_F(PlantEffects, ABuildingIsMadeAnewAtItsDatesAlone) {
  auto counted = std::make_unique<Counted>();
  const Counted& counter = *counted;
  const auto later = within_dates(std::move(counted), 150.0, 1e9);
  run(later.get());
  EXPECT_GE(counter.times, 1);
  EXPECT_LE(counter.times, 4);
}

// --- Plant ---

TEST_F(PlantEffects, ChillerPaysForPartLoadAndWarmCondensers) {
  // 1.3 x 1.2 kJ/(m3 K) x 25 m3/s x 11 K at design, here at half of it.
  StepLoads loads = some_loads();
  loads.sensible_cooling_W =
      0.5 * 1.3 * weather::air_heat_capacity_J_m3K(drivers_->pressure_Pa) * 25.0 * 11.0;
  StepOperation hot = cold_night();
  hot.dry_bulb_C = 35.0;  // condenser 40 C
  const auto chiller = bind("chiller_part_load", {0.2, 0.01});
  EXPECT_NEAR(supplied(*chiller, hour_at(7, 20, 15), hot, loads).cooling_cost_factor, 1.2 * 1.1,
              1e-12);
  EXPECT_NEAR(supplied(*chiller, hour_at(1, 20, 3), cold_night(), loads).cooling_cost_factor,
              1.2 * 0.9, 1e-12);

  building_.chiller_cop = 4.0;
  const Eigen::Array3d change_MWh = yearly_change_MWh("chiller_part_load", {0.2, 0.0});
  EXPECT_GT(change_MWh[0], 0.0);
  EXPECT_EQ(change_MWh[2], 0.0);
}

TEST_F(PlantEffects, FoulingGrowsAndRestartsAfterCleaning) {
  const auto fouling = bind("fouling", {0.1, 30.0, 200.0});
  const auto factor_on = [&](int day_index) {
    return supplied(*fouling, drivers_->hours[static_cast<std::size_t>(24 * day_index)],
                    cold_night(), some_loads())
        .cooling_cost_factor;
  };
  EXPECT_EQ(factor_on(20), 1.0);
  EXPECT_NEAR(factor_on(130), 1.0 + 0.1 * 100.0 / 365.25, 1e-3);
  EXPECT_NEAR(factor_on(210), 1.0 + 0.1 * 10.0 / 365.25, 1e-3);

  const Eigen::Array3d change_MWh = yearly_change_MWh("fouling", {0.1, 0.0, 365.0});
  EXPECT_EQ(change_MWh[0], 0.0);
  EXPECT_GT(change_MWh[1], 0.0);
  EXPECT_EQ(change_MWh[2], 0.0);
}

TEST_F(PlantEffects, HotWaterIsDrawnFromColdMainsAndLosesInItsLoop) {
  // 2 m3/day lifted 8 K more: 2 x 1163/24 x 8 = 775.3 W; on day 47.5 mains are coldest.
  const DriverHour& coldest = hour_at(2, 16, 12);
  const auto water = bind("seasonal_hot_water", {0.0, 8.0, 1.5});
  EXPECT_NEAR(supplied(*water, coldest, cold_night(), some_loads()).hot_water_W,
              4e3 + 775.33 + 1.5e3, 0.5);
  const auto more = bind("seasonal_hot_water", {2.0, 8.0, 1.5});
  EXPECT_NEAR(supplied(*more, coldest, cold_night(), some_loads()).hot_water_W,
              4e3 + 775.33 + 1.5e3 + 2e3 * (1.0 + 8.0 / 45.0), 0.5);
  const Eigen::Array3d change_MWh = yearly_change_MWh("seasonal_hot_water", {0.0, 8.0, 1.5});
  EXPECT_EQ(change_MWh[0], 0.0);
  EXPECT_EQ(change_MWh[1], 0.0);
  EXPECT_NEAR(change_MWh[2], 1.5 * 8.76 / (0.9 * 0.95), 0.1);
}

TEST_F(PlantEffects, LeakingTrapsCountAtAllHours) {
  const Eigen::ArrayXXd change_kW = run(bind("steam_trap_leak", {7.0}).get()) - run(nullptr);
  EXPECT_NEAR(change_kW.col(2).minCoeff(), 7.0, 1e-9);
  EXPECT_NEAR(change_kW.col(2).maxCoeff(), 7.0, 1e-9);
  EXPECT_EQ(change_kW.leftCols(2).abs().maxCoeff(), 0.0);
}

TEST_F(PlantEffects, FrostCostsMostJustAboveFreezingInDampAir) {
  const auto frost = bind("heat_pump_defrost", {0.2});
  const auto factor_at = [&](double dry_bulb_C, double relative_humidity) {
    StepOperation air = cold_night();
    air.dry_bulb_C = dry_bulb_C;
    air.humidity_ratio =
        weather::humidity_ratio(dry_bulb_C, relative_humidity, drivers_->pressure_Pa);
    return supplied(*frost, hour_at(1, 20, 3), air, some_loads()).heating_cost_factor;
  };
  EXPECT_NEAR(factor_at(1.0, 1.0), 1.25, 1e-9);
  EXPECT_NEAR(factor_at(7.0, 1.0), 1.0 / (1.0 - 0.2 * std::exp(-2.0)), 1e-9);
  EXPECT_EQ(factor_at(1.0, 0.4), 1.0);
  EXPECT_LT(factor_at(-15.0, 1.0), 1.001);
}

// --- Electrical load ---

TEST_F(PlantEffects, PlugsGrowAboutTheMiddleOfTheRecord) {
  const auto growth = bind("plug_growth", {0.05});
  const StepOperation first = operated(*growth, drivers_->hours.front(), cold_night());
  EXPECT_NEAR(first.plugs_W, 20e3 * (1.0 - 0.05 * 0.5), 2.0);

  const Eigen::ArrayXXd change_kW = run(growth.get()) - run(nullptr);
  const Eigen::Index half = change_kW.rows() / 2;
  EXPECT_LT(change_kW.col(0).head(half - 24).maxCoeff(), 0.0);
  EXPECT_GT(change_kW.col(0).tail(half - 24).minCoeff(), 0.0);
  EXPECT_GT(change_kW.col(1).tail(half).sum(), 0.0);  // the echo of the heat
  EXPECT_LT(change_kW.col(2).tail(half).sum(), 0.0);
}

TEST_F(PlantEffects, EquipmentAddsPowerAndItsHeat) {
  const DriverHour& night = hour_at(1, 20, 3);
  EXPECT_NEAR(operated(*bind("equipment_step", {5.0, 0.4}), night, cold_night()).plugs_W,
              20e3 + 0.6 * 5e3, 1e-6);
  const StepOperation less = operated(*bind("equipment_step", {-5.0, 0.4}), night, cold_night());
  const double there_W = cold_night().lights_W + cold_night().plugs_W;
  EXPECT_NEAR(less.plugs_W + less.lights_W, there_W - 0.6 * 5e3, 1e-6);
  EXPECT_NEAR(less.plugs_W / less.lights_W, cold_night().plugs_W / cold_night().lights_W, 1e-6);
  EXPECT_EQ(operated(*bind("equipment_step", {-500.0, 0.4}), night, cold_night()).plugs_W, 0.0);

  const Eigen::Array3d change_MWh = yearly_change_MWh("equipment_step", {10.0, 0.5});
  EXPECT_GT(change_MWh[0], 87.0);
  EXPECT_GT(change_MWh[1], 0.0);
  EXPECT_LT(change_MWh[2], 0.0);
}

TEST_F(PlantEffects, ServersAreCooledAlsoOnWinterNights) {
  const auto server = bind("server_room", {8.0, 0.75, 0.5});
  const DriverHour& night = hour_at(1, 20, 3);
  const StepOperation operation = operated(*server, night, cold_night());
  EXPECT_EQ(operation.plugs_W, 16e3);
  EXPECT_EQ(operation.zone_gain_W, 2e3);
  const StepLoads loads = supplied(*server, night, operation, some_loads());
  EXPECT_EQ(loads.plugs_W, 28e3);
  EXPECT_EQ(loads.sensible_cooling_W, 6e3);

  const Eigen::ArrayXXd change_kW = run(bind("server_room", {10.0, 1.0, 0.0}).get()) - run(nullptr);
  EXPECT_NEAR(change_kW.col(0).minCoeff(), 10.0, 1e-9);
  EXPECT_NEAR(change_kW.col(1).minCoeff(), 10.3, 1e-9);  // with the network's losses
  EXPECT_LT(yearly_change_MWh("server_room", {10.0, 0.0, 0.0})[2], 0.0);
}

TEST_F(PlantEffects, LampsBurnInTheDarkAndWarmNobody) {
  const auto lamps = bind("exterior_lighting", {5.0, 0.0});
  EXPECT_EQ(operated(*lamps, hour_at(6, 21, 12), cold_night()).exterior_W, 0.0);
  EXPECT_EQ(operated(*lamps, hour_at(1, 20, 23), cold_night()).exterior_W, 5e3);
  DriverHour dusk = hour_at(1, 20, 18);
  dusk.sine_of_sun_altitude = -0.0349;  // switches in the middle of the hour
  EXPECT_NEAR(operated(*lamps, dusk, cold_night()).exterior_W, 2.5e3, 1e-9);

  const Eigen::Array3d change_MWh = yearly_change_MWh("exterior_lighting", {5.0, 0.0});
  EXPECT_NEAR(change_MWh[0], 5.0 * 4.2, 1.5);  // dark for some 4200 h a year
  EXPECT_EQ(change_MWh[1], 0.0);
  EXPECT_EQ(change_MWh[2], 0.0);
}

// What the plug profile already held of the lamps leaves the yearly sum as it was.
TEST_F(PlantEffects, LampsOutOfTheProfileMoveWithTheSeasonsAlone) {
  EXPECT_NEAR(yearly_change_MWh("exterior_lighting", {5.0, 1.0})[0], 0.0, 1.0);
}

TEST_F(PlantEffects, LoadIsShedOnHotAfternoonsAndComesBack) {
  const auto limit = bind("demand_limit", {0.25, 0.4, -50.0});  // every working day
  const auto plugs_W = [&](int local_hour) {
    return operated(*limit, hour_at(7, 20, local_hour), cold_night()).plugs_W;
  };
  EXPECT_EQ(plugs_W(12), 20e3);
  EXPECT_EQ(plugs_W(13), 15e3);
  EXPECT_EQ(plugs_W(17), 15e3);
  EXPECT_NEAR(plugs_W(19), 22e3, 1e-9);
  EXPECT_EQ(plugs_W(20), 20e3);
  EXPECT_EQ(supplied(*limit, hour_at(7, 20, 14), cold_night(), some_loads()).fans_W, 7.5e3);
  EXPECT_EQ(operated(*limit, hour_at(7, 24, 14), cold_night()).plugs_W, 20e3);  // a Saturday

  const auto hot = bind("demand_limit", {0.25, 0.0, 100.0});
  EXPECT_EQ(operated(*hot, hour_at(7, 20, 14), cold_night()).plugs_W, 20e3);
  const Eigen::Array3d change_MWh = yearly_change_MWh("demand_limit", {0.25, 0.2, 25.0});
  EXPECT_LT(change_MWh[0], 0.0);
  EXPECT_LT(change_MWh[1], 0.0);  // less heat from lights and plugs
}

// --- Meters ---

/// Hours 0…3 of one day and 6…9, as where a month between is left out.
std::vector<DriverHour> two_stretches(const model::Drivers& drivers) {
  const auto& all = drivers.hours;
  std::vector<DriverHour> hours(all.begin(), all.begin() + 4);
  hours.insert(hours.end(), all.begin() + 6, all.begin() + 10);
  return hours;
}

TEST_F(PlantEffects, StuckMeterRepeatsItsFirstValueOrZero) {
  const std::vector<DriverHour> hours = two_stretches(*drivers_);
  std::vector<double> power_kW{4, 5, 6, 7, 8, 9, 10, 11};
  bind("stuck_meter", {1.0, 1.0}, 0)->record(hours, 0, power_kW);
  EXPECT_EQ(power_kW, std::vector<double>(8, 4.0));
  power_kW = {4, 5, 6, 7, 8, 9, 10, 11};
  bind("stuck_meter", {0.5, 0.0}, 0)->record(hours, 0, power_kW);
  EXPECT_EQ(power_kW, (std::vector<double>{2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5}));
  bind("stuck_meter", {1.0, 0.0}, 1)->record(hours, 0, power_kW);  // another meter
  EXPECT_EQ(power_kW.front(), 2.0);
}

TEST_F(PlantEffects, ScaleAndLostPhaseMultiply) {
  const std::vector<DriverHour> hours = two_stretches(*drivers_);
  std::vector<double> power_kW(8, 30.0);
  bind("scale_fault", {1.5}, 0)->record(hours, 0, power_kW);
  EXPECT_EQ(power_kW, std::vector<double>(8, 45.0));
  bind("phase_lost", {1.0 / 3.0}, 0)->record(hours, 0, power_kW);
  for (const double value_kW : power_kW) EXPECT_NEAR(value_kW, 30.0, 1e-12);
}

TEST_F(PlantEffects, ClockShowsWhatHappensLaterAndStaysWithinItsStretch) {
  const std::vector<DriverHour> hours = two_stretches(*drivers_);
  std::vector<double> power_kW{0, 4, 8, 12, 100, 104, 108, 112};
  bind("clock_offset", {0.25}, 0)->record(hours, 0, power_kW);
  EXPECT_EQ(power_kW, (std::vector<double>{1, 5, 9, 12, 101, 105, 109, 112}));
  power_kW = {0, 4, 8, 12, 100, 104, 108, 112};
  bind("clock_offset", {-2.0}, 0)->record(hours, 0, power_kW);
  EXPECT_EQ(power_kW, (std::vector<double>{0, 0, 0, 4, 100, 100, 100, 104}));
}

TEST_F(PlantEffects, ClockShiftsQuarterHoursByFourAnHour) {
  const std::span hours = std::span{drivers_->hours}.first(2);
  std::vector<double> power_kW{0, 1, 2, 3, 4, 5, 6, 7};
  bind("clock_offset", {0.5}, 0)->record(hours, 0, power_kW);
  EXPECT_EQ(power_kW, (std::vector<double>{2, 3, 4, 5, 6, 7, 7, 7}));
}

TEST_F(PlantEffects, DaylightSavingShiftsSummerOnAllMeters) {
  const auto shift = bind("dst_misapplied", {1.0});
  std::vector<double> power_kW(drivers_->hours.size());
  for (std::size_t i = 0; i < power_kW.size(); ++i) power_kW[i] = static_cast<double>(i);
  shift->record(drivers_->hours, 2, power_kW);
  int summer_hours = 0;
  for (std::size_t i = 0; i < power_kW.size(); ++i) {
    const bool summer = drivers_->hours[i].daylight_saving;
    EXPECT_EQ(power_kW[i], static_cast<double>(i) + (summer ? 1.0 : 0.0));
    summer_hours += summer ? 1 : 0;
  }
  EXPECT_EQ(summer_hours, 238 * 24 - 1);  // 14 March 2:00 to 7 November 1:00 of winter time, 2021
}

}  // namespace
}  // namespace recald::diagnosis::effects_plant_test
