#include "simulators/climate/air.hpp"

#include <gtest/gtest.h>

namespace recald::simulators {
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
}  // namespace recald::simulators
