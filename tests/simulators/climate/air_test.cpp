#include "simulators/climate/air.hpp"

#include <gtest/gtest.h>

namespace recald::simulators::air_test {
namespace {

// ASHRAE Handbook Fundamentals 2017, chapter 1, table 3, over liquid water. Buck's formula is
// specified to 0.1 %.
TEST(Air, SaturationPressureMeetsAshraeTable) {
  struct Case {
    double temperature_C;
    double pressure_Pa;
  };
  for (const Case& c : {Case{0.01, 611.7}, Case{10.0, 1228.2}, Case{20.0, 2339.2},
                        Case{25.0, 3169.7}, Case{30.0, 4246.7}, Case{35.0, 5628.6}}) {
    EXPECT_NEAR(saturation_pressure_Pa(c.temperature_C), c.pressure_Pa, 1e-3 * c.pressure_Pa)
        << c.temperature_C << " degC";
  }
}

// ASHRAE Handbook Fundamentals 2017, chapter 1, table 2 at 101.325 kPa; the table includes the
// enhancement factor of 0.4 %, which the simulator leaves out.
TEST(Air, SaturatedAirMeetsAshraeTable) {
  EXPECT_NEAR(saturation_humidity_kg_kg(20.0, kSeaLevel_Pa), 0.014758, 0.6e-2 * 0.014758);
  EXPECT_NEAR(saturation_humidity_kg_kg(30.0, kSeaLevel_Pa), 0.027329, 0.6e-2 * 0.027329);
  const AirState saturated{20.0, 0.014758};
  EXPECT_NEAR(enthalpy_J_kg(saturated), 57'555.0, 100.0);
}

TEST(Air, DewPointInvertsSaturation) {
  for (double temperature_C = -15.0; temperature_C <= 40.0; temperature_C += 2.5) {
    EXPECT_NEAR(dew_point_C(saturation_pressure_Pa(temperature_C)), temperature_C, 1e-9);
  }
}

TEST(Air, VapourPressureInvertsHumidity) {
  EXPECT_NEAR(vapour_pressure_Pa(humidity_from_vapour_kg_kg(1500.0, 97'000.0), 97'000.0), 1500.0,
              1e-9);
}

TEST(Air, MixingConservesEnthalpyAndWater) {
  const AirState outdoor{34.0, 0.018};
  const AirState returned{24.0, 0.009};
  const AirState mixed = mix(outdoor, returned, 0.3);
  EXPECT_NEAR(enthalpy_J_kg(mixed), 0.3 * enthalpy_J_kg(outdoor) + 0.7 * enthalpy_J_kg(returned),
              1e-9);
  EXPECT_NEAR(mixed.humidity_kg_kg, 0.3 * 0.018 + 0.7 * 0.009, 1e-15);
}

// ASHRAE Handbook Fundamentals 2017, chapter 1, eq. (33): humidity ratio of air at t whose wet
// bulb is t*, from the handbook's saturated humidity ratio (table 2). The worked example there is
// 40 / 20 degC, 6.5 g/kg.
TEST(Air, WetBulbMeetsAshraeEquation) {
  struct Case {
    double dry_C;
    double wet_C;
    double saturated_kg_kg;  ///< At the wet bulb, 101.325 kPa.
  };
  for (const Case& c :
       {Case{40.0, 20.0, 0.014758}, Case{35.0, 25.0, 0.020170}, Case{30.0, 30.0, 0.027329},
        Case{20.0, 10.0, 0.007661}, Case{5.0, 1.0, 0.004076}}) {
    SCOPED_TRACE(c.dry_C);
    const double humidity =
        ((2501.0 - 2.326 * c.wet_C) * c.saturated_kg_kg - 1.006 * (c.dry_C - c.wet_C)) /
        (2501.0 + 1.86 * c.dry_C - 4.186 * c.wet_C);
    EXPECT_NEAR(wet_bulb_C({c.dry_C, humidity}, kSeaLevel_Pa), c.wet_C, 0.06);
  }
}

TEST(Air, WetBulbLiesBetweenDewPointAndDryBulb) {
  for (double dry_C = -30.0; dry_C <= 48.0; dry_C += 6.0) {
    double drier_C = -99.0;
    for (const double humidity : {0.05, 0.3, 0.6, 0.9}) {
      const double pressure_Pa = 97'000.0;
      const double vapour_Pa = humidity * saturation_pressure_Pa(dry_C);
      const double wet_C =
          wet_bulb_C({dry_C, humidity_from_vapour_kg_kg(vapour_Pa, pressure_Pa)}, pressure_Pa);
      EXPECT_LT(wet_C, dry_C);
      EXPECT_GT(wet_C, dew_point_C(vapour_Pa));
      EXPECT_GT(wet_C, drier_C) << "moister air has the higher wet bulb";
      drier_C = wet_C;
    }
    const AirState saturated{dry_C, saturation_humidity_kg_kg(dry_C, kSeaLevel_Pa)};
    EXPECT_NEAR(wet_bulb_C(saturated, kSeaLevel_Pa), dry_C, 1e-6);
    EXPECT_EQ(wet_bulb_C({dry_C, 1.01 * saturated.humidity_kg_kg}, kSeaLevel_Pa), dry_C);
  }
}

// Standard atmosphere (ICAO): 95,461 Pa at 500 m.
TEST(Air, PressureFallsWithAltitude) {
  EXPECT_NEAR(pressure_at_altitude_Pa(0.0), kSeaLevel_Pa, 1e-9);
  EXPECT_NEAR(pressure_at_altitude_Pa(500.0), 95'461.0, 20.0);
}

TEST(Air, RelativeHumidityIsCappedAtSaturation) {
  EXPECT_DOUBLE_EQ(relative_humidity({10.0, 0.020}, kSeaLevel_Pa), 1.0);
  EXPECT_NEAR(
      relative_humidity({25.0, 0.5 * saturation_humidity_kg_kg(25.0, kSeaLevel_Pa)}, kSeaLevel_Pa),
      0.508, 0.002);
}

}  // namespace
}  // namespace recald::simulators::air_test
