#include "simulators/building/cooling_coil.hpp"

#include <gtest/gtest.h>

namespace recald::simulators::cooling_coil_test {
namespace {

constexpr CoolingCoil kCoil{.capacity_W = 500e3,
                            .design_flow_kg_s = 10.0,
                            .design_bypass_factor = 0.1,
                            .lowest_apparatus_dew_point_C = 8.5};

TEST(CoolingCoil, HoldsTheTargetAndConservesEnergyAndWater) {
  const AirState warm{30.0, 0.016};
  const CoilWork work = cool(kCoil, warm, 8.0, 13.0, kSeaLevel_Pa);
  EXPECT_NEAR(work.leaving.temperature_C, 13.0, 1e-9);
  EXPECT_LT(work.leaving.humidity_kg_kg, 0.0098);
  EXPECT_LE(relative_humidity(work.leaving, kSeaLevel_Pa), 1.0);
  EXPECT_NEAR(work.condensate_kg_s, 8.0 * (warm.humidity_kg_kg - work.leaving.humidity_kg_kg),
              1e-12);
  const double drained_W = work.condensate_kg_s * kWaterHeat_J_kgK * work.leaving.temperature_C;
  EXPECT_NEAR(work.total_W, 8.0 * (enthalpy_J_kg(warm) - enthalpy_J_kg(work.leaving)) - drained_W,
              1e-6);
  EXPECT_GT(work.total_W, work.sensible_W);
}

TEST(CoolingCoil, DryAirStaysDry) {
  const CoilWork work = cool(kCoil, {28.0, 0.005}, 8.0, 14.0, kSeaLevel_Pa);
  EXPECT_EQ(work.condensate_kg_s, 0.0);
  EXPECT_DOUBLE_EQ(work.leaving.humidity_kg_kg, 0.005);
  EXPECT_NEAR(work.total_W, work.sensible_W, 1e-6 * work.total_W);
}

TEST(CoolingCoil, ColdAirPassesUntouched) {
  const CoilWork work = cool(kCoil, {11.0, 0.005}, 8.0, 13.0, kSeaLevel_Pa);
  EXPECT_EQ(work.total_W, 0.0);
  EXPECT_EQ(work.leaving.temperature_C, 11.0);
}

TEST(CoolingCoil, NeverUsesMoreThanItsCapacity) {
  CoolingCoil small = kCoil;
  small.capacity_W = 100e3;
  const CoilWork work = cool(small, {35.0, 0.020}, 10.0, 12.0, kSeaLevel_Pa);
  EXPECT_NEAR(work.total_W, 100e3, 1.5e3);  // the coil line is straight in h to second order
  EXPECT_GT(work.leaving.temperature_C, 12.0);
}

TEST(CoolingCoil, WaterCannotCoolBelowItself) {
  const CoilWork work = cool(kCoil, {32.0, 0.018}, 10.0, 5.0, kSeaLevel_Pa);
  EXPECT_NEAR(work.leaving.temperature_C, 0.1 * 32.0 + 0.9 * 8.5, 1e-9);
}

TEST(CoolingCoil, SlowerAirIsTreatedMoreThoroughly) {
  // Same leaving temperature, less bypass: the fins may be warmer, so less water is drawn out.
  const CoilWork fast = cool(kCoil, {30.0, 0.014}, 10.0, 13.0, kSeaLevel_Pa);
  const CoilWork slow = cool(kCoil, {30.0, 0.014}, 3.0, 13.0, kSeaLevel_Pa);
  EXPECT_GT(slow.leaving.humidity_kg_kg, fast.leaving.humidity_kg_kg + 2e-4);
  EXPECT_LT(slow.total_W, fast.total_W);
}

}  // namespace
}  // namespace recald::simulators::cooling_coil_test
