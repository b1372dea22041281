#include "simulators/climate/air.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace recald::simulators {
namespace {

constexpr double kWaterToAirMolarMass = 0.621945;
constexpr double kDryAirGasConstant_J_kgK = 287.042;

}  // namespace

double saturation_pressure_Pa(double temperature_C) {
  return 611.21 *
         std::exp((18.678 - temperature_C / 234.5) * temperature_C / (257.14 + temperature_C));
}

double humidity_from_vapour_kg_kg(double vapour_pressure_Pa, double pressure_Pa) {
  return kWaterToAirMolarMass * vapour_pressure_Pa / (pressure_Pa - vapour_pressure_Pa);
}

double vapour_pressure_Pa(double humidity_kg_kg, double pressure_Pa) {
  return pressure_Pa * humidity_kg_kg / (kWaterToAirMolarMass + humidity_kg_kg);
}

double saturation_humidity_kg_kg(double temperature_C, double pressure_Pa) {
  return humidity_from_vapour_kg_kg(saturation_pressure_Pa(temperature_C), pressure_Pa);
}

double dew_point_C(double vapour_pressure_Pa) {
  assert(vapour_pressure_Pa > 0.0);
  // Buck's exponent is a quadratic in the temperature once the denominator is multiplied out:
  // t²/234.5 − (18.678 − y) t + 257.14 y = 0 with y = ln(e / 611.21).
  const double y = std::log(vapour_pressure_Pa / 611.21);
  const double b = 18.678 - y;
  const double root = std::sqrt(b * b - 4.0 * 257.14 * y / 234.5);
  return 2.0 * 257.14 * y / (b + root);
}

double relative_humidity(const AirState& air, double pressure_Pa) {
  return std::min(1.0, vapour_pressure_Pa(air.humidity_kg_kg, pressure_Pa) /
                           saturation_pressure_Pa(air.temperature_C));
}

double enthalpy_J_kg(const AirState& air) {
  return kDryAirHeat_J_kgK * air.temperature_C +
         air.humidity_kg_kg * (kEvaporation_J_kg + kVapourHeat_J_kgK * air.temperature_C);
}

double wet_bulb_C(const AirState& air, double pressure_Pa) {
  // Air that takes up water at the wet-bulb temperature until it is saturated keeps its enthalpy,
  // except for that of the added water:
  // f(t) = h(t, ws(t)) − h(air) − (ws(t) − w) cw t = 0.
  // f rises with t and is convex, so Newton's steps from the dry bulb descend to the root.
  constexpr int steps_max = 30;
  constexpr double difference_K = 1e-3;
  const double enthalpy = enthalpy_J_kg(air);
  const auto excess_J_kg = [&](double t_C) {
    const double saturated = saturation_humidity_kg_kg(t_C, pressure_Pa);
    return enthalpy_J_kg({t_C, saturated}) - enthalpy -
           (saturated - air.humidity_kg_kg) * kWaterHeat_J_kgK * t_C;
  };
  double wet_C = air.temperature_C;
  for (int step = 0; step < steps_max; ++step) {
    const double excess = excess_J_kg(wet_C);
    if (excess <= 0.0) break;  // saturated from the start, or at the root
    const double slope = (excess - excess_J_kg(wet_C - difference_K)) / difference_K;
    wet_C -= excess / slope;
    if (excess / slope < 1e-6) break;
  }
  return wet_C;
}

double density_kg_m3(double temperature_C, double pressure_Pa) {
  return pressure_Pa / (kDryAirGasConstant_J_kgK * (temperature_C + 273.15));
}

double pressure_at_altitude_Pa(double altitude_m) {
  return kSeaLevel_Pa * std::pow(1.0 - 2.25577e-5 * altitude_m, 5.2559);
}

AirState mix(const AirState& first, const AirState& second, double share) {
  const double humidity = share * first.humidity_kg_kg + (1.0 - share) * second.humidity_kg_kg;
  const double enthalpy = share * enthalpy_J_kg(first) + (1.0 - share) * enthalpy_J_kg(second);
  return {(enthalpy - kEvaporation_J_kg * humidity) /
              (kDryAirHeat_J_kgK + kVapourHeat_J_kgK * humidity),
          humidity};
}

}  // namespace recald::simulators
