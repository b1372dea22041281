#include "simulators/building/plant.hpp"

#include <gtest/gtest.h>

namespace recald::simulators::plant_test {
namespace {

/// A plant with nothing on its meters but what cools, all as on the nameplate.
Truth bare(CoolingPlant cooling, double cop) {
  Drawings drawings;
  drawings.cooling = cooling;
  drawings.chiller_cop = cop;
  drawings.chilled_water_design_kW = 100.0;
  Truth truth = draw_truth(drawings, 1);
  truth.chiller_cop_scale = 1.0;
  truth.pump_kW = truth.exterior_kW = truth.hot_water_m3_day = 0.0;
  truth.chilled_water_loss_share = 0.03;
  truth.chilled_water_standing_kW = 4.0;
  return truth;
}

Outdoors outdoors_at(double dry_bulb_C, double humidity_kg_kg) {
  Outdoors outdoors{};
  outdoors.air = {dry_bulb_C, humidity_kg_kg};
  outdoors.pressure_Pa = 101'325.0;
  return outdoors;
}

UtilityPower run(const Truth& truth, double cooling_kW, const Outdoors& outdoors) {
  Plant plant(truth, 900.0, Rng{1});
  ServiceLoad load;
  load.cooling_W = 1000.0 * cooling_kW;
  return plant.advance(load, {}, outdoors);
}

// AHRI 340/360: full load at 35 degC outdoors, whatever the humidity.
TEST(Plant, PackagedUnitsHaveTheirNameplateCopAtTheirRating) {
  const Truth truth = bare(CoolingPlant::packaged, 3.3);
  const UtilityPower dry = run(truth, 100.0, outdoors_at(35.0, 0.008));
  EXPECT_NEAR(dry.electricity_kW, 100.0 / 3.3, 1e-9);
  EXPECT_EQ(dry.electricity_kW, run(truth, 100.0, outdoors_at(35.0, 0.020)).electricity_kW);
  EXPECT_LT(run(truth, 100.0, outdoors_at(20.0, 0.008)).electricity_kW, 0.8 * dry.electricity_kW);
  // A stage cycles: a tenth of the load takes more than a tenth of the power, less than a quarter.
  const double tenth_kW = run(truth, 10.0, outdoors_at(35.0, 0.008)).electricity_kW;
  EXPECT_GT(tenth_kW, 0.1 * dry.electricity_kW);
  EXPECT_LT(tenth_kW, 0.25 * dry.electricity_kW);
}

TEST(Plant, PackagedUnitsCoolTheAirItselfAndLoseNothingInPipes) {
  const Outdoors outdoors = outdoors_at(30.0, 0.012);
  EXPECT_EQ(run(bare(CoolingPlant::packaged, 3.3), 50.0, outdoors).cooling_kW, 50.0);
  EXPECT_NEAR(run(bare(CoolingPlant::chiller, 5.2), 50.0, outdoors).cooling_kW, 1.03 * 50.0 + 4.0,
              1e-9);
}

}  // namespace
}  // namespace recald::simulators::plant_test
