/// Moist air against the tables of the ASHRAE Handbook Fundamentals (2009), chapter 1: Table 1
/// (standard atmosphere) and Table 3 (water at saturation).
#include "core/weather/psychrometrics.hpp"

#include <gtest/gtest.h>

namespace recald::weather {
namespace {

constexpr double kSeaLevel_Pa = 101325.0;

TEST(SaturationPressure, MeetsTheTableOfWaterAtSaturation) {
  struct Row {
    double temperature_C;
    double pressure_Pa;
  };
  for (const Row& row : {Row{-20.0, 103.24}, Row{-10.0, 259.87}, Row{0.0, 611.2}, Row{10.0, 1228.0},
                         Row{20.0, 2338.8}, Row{30.0, 4246.0}, Row{40.0, 7383.5}}) {
    SCOPED_TRACE(row.temperature_C);
    EXPECT_NEAR(saturation_pressure_Pa(row.temperature_C), row.pressure_Pa, 1e-3 * row.pressure_Pa);
  }
}

TEST(SaturationPressure, RisesThroughFreezingWithoutAStep) {
  EXPECT_NEAR(saturation_pressure_Pa(-1e-9), saturation_pressure_Pa(0.0), 0.2);
  for (double temperature_C = -40.0; temperature_C < 60.0; temperature_C += 0.5) {
    EXPECT_LT(saturation_pressure_Pa(temperature_C), saturation_pressure_Pa(temperature_C + 0.5));
  }
}

// By hand: 0.621945 · 1584.6 / (101325 − 1584.6) = 0.009881 at 25 °C and 50 %.
TEST(HumidityRatio, MeetsThePsychrometricChart) {
  EXPECT_NEAR(humidity_ratio(25.0, 0.5, kSeaLevel_Pa), 0.00988, 1e-5);
  // Table 2, W_s. Its real air holds 0.4 % more water than the ideal gas of eq. (22).
  EXPECT_NEAR(humidity_ratio(20.0, 1.0, kSeaLevel_Pa), 0.014758, 0.005 * 0.014758);
  EXPECT_NEAR(humidity_ratio(0.0, 1.0, kSeaLevel_Pa), 0.003789, 0.005 * 0.003789);
  EXPECT_EQ(humidity_ratio(25.0, 0.0, kSeaLevel_Pa), 0.0);
}

// Read off the chart for sea level.
TEST(WetBulb, MeetsThePsychrometricChart) {
  struct Row {
    double dry_bulb_C, relative_humidity, wet_bulb_C;
  };
  for (const Row& row : {Row{10.0, 0.5, 5.5}, Row{20.0, 0.5, 13.8}, Row{30.0, 0.5, 22.0},
                         Row{35.0, 0.2, 18.9}, Row{40.0, 0.1, 18.6}}) {
    SCOPED_TRACE(row.dry_bulb_C);
    const double ratio = humidity_ratio(row.dry_bulb_C, row.relative_humidity, kSeaLevel_Pa);
    EXPECT_NEAR(wet_bulb_C(row.dry_bulb_C, ratio, kSeaLevel_Pa), row.wet_bulb_C, 0.5);
  }
}

TEST(WetBulb, IsTheDryBulbOfSaturatedAirAndNeverMore) {
  const double saturated = humidity_ratio(20.0, 1.0, kSeaLevel_Pa);
  EXPECT_NEAR(wet_bulb_C(20.0, saturated, kSeaLevel_Pa), 20.0, 1e-9);
  EXPECT_EQ(wet_bulb_C(20.0, 1.1 * saturated, kSeaLevel_Pa), 20.0);
  EXPECT_LT(wet_bulb_C(-10.0, 0.0, kSeaLevel_Pa), -10.0);
}

TEST(HumidityRatio, IsLargerWhereTheAirIsThinner) {
  EXPECT_GT(humidity_ratio(25.0, 0.5, 84'556.0), humidity_ratio(25.0, 0.5, kSeaLevel_Pa));
}

// A broken sensor gives a large number, never a negative one or infinity.
TEST(HumidityRatio, StaysFiniteWhenVapourPressureExceedsTheAirs) {
  const double ratio = humidity_ratio(99.0, 1.0, 60'000.0);
  EXPECT_GT(ratio, 0.0);
  EXPECT_LT(ratio, 20.0);
}

TEST(PressureAtAltitude, MeetsTheStandardAtmosphere) {
  EXPECT_DOUBLE_EQ(pressure_at_altitude_Pa(0.0), kSeaLevel_Pa);
  EXPECT_NEAR(pressure_at_altitude_Pa(500.0), 95'461.0, 10.0);
  EXPECT_NEAR(pressure_at_altitude_Pa(1500.0), 84'556.0, 10.0);
  EXPECT_NEAR(pressure_at_altitude_Pa(3000.0), 70'108.0, 10.0);
}

TEST(AirHeatCapacity, ScalesWithPressure) {
  EXPECT_DOUBLE_EQ(air_heat_capacity_J_m3K(kSeaLevel_Pa), 1200.0);
  EXPECT_DOUBLE_EQ(air_heat_capacity_J_m3K(0.5 * kSeaLevel_Pa), 600.0);
}

}  // namespace
}  // namespace recald::weather
