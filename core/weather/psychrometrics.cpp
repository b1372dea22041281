#include "core/weather/psychrometrics.hpp"

#include <algorithm>
#include <cmath>

namespace recald::weather {
namespace {

constexpr double kSeaLevelPressure_Pa = 101325.0;
constexpr double kMolarMassRatio = 0.621945;     // water over dry air
constexpr double kClausiusClapeyron_K = 5400.0;  // d ln p / d(1/T) of water, near 10 °C
constexpr int kWetBulbSteps = 7;

}  // namespace

double saturation_pressure_Pa(double temperature_C) {
  const double kelvin = temperature_C + 273.15;
  if (temperature_C < 0.0) {  // eq. (5), over ice
    return std::exp(-5.6745359e3 / kelvin + 6.3925247 - 9.677843e-3 * kelvin +
                    6.2215701e-7 * kelvin * kelvin + 2.0747825e-9 * std::pow(kelvin, 3) -
                    9.484024e-13 * std::pow(kelvin, 4) + 4.1635019 * std::log(kelvin));
  }
  return std::exp(-5.8002206e3 / kelvin + 1.3914993 - 4.8640239e-2 * kelvin +  // eq. (6)
                  4.1764768e-5 * kelvin * kelvin - 1.4452093e-8 * std::pow(kelvin, 3) +
                  6.5459673 * std::log(kelvin));
}

double humidity_ratio(double temperature_C, double relative_humidity, double pressure_Pa) {
  const double vapour_Pa = relative_humidity * saturation_pressure_Pa(temperature_C);
  // A sensor that reads 60 °C at 100 % on a mountain must not divide by zero.
  return kMolarMassRatio * vapour_Pa / std::max(pressure_Pa - vapour_Pa, 0.1 * pressure_Pa);
}

double wet_bulb_C(double dry_bulb_C, double humidity_ratio, double pressure_Pa) {
  // Newton's method from above: the balance is convex in the wet bulb.
  constexpr double kPerRatio_K = kVaporisationHeat_J_kg / kAirHeatCapacity_J_kgK;
  double wet_C = dry_bulb_C;
  for (int step = 0; step < kWetBulbSteps; ++step) {
    const double kelvin = wet_C + 273.15;
    const double saturated = weather::humidity_ratio(wet_C, 1.0, pressure_Pa);
    const double excess_K = wet_C - dry_bulb_C + kPerRatio_K * (saturated - humidity_ratio);
    wet_C -= excess_K / (1.0 + kPerRatio_K * saturated * kClausiusClapeyron_K / (kelvin * kelvin));
  }
  return std::min(wet_C, dry_bulb_C);
}

double pressure_at_altitude_Pa(double altitude_m) {
  return kSeaLevelPressure_Pa * std::pow(1.0 - 2.25577e-5 * altitude_m, 5.2559);
}

double air_heat_capacity_J_m3K(double pressure_Pa) {
  return 1200.0 * pressure_Pa / kSeaLevelPressure_Pa;
}

}  // namespace recald::weather
