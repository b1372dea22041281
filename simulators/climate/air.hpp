/// Moist air for the simulators alone.
#pragma once

namespace recald::simulators {

inline constexpr double kDryAirHeat_J_kgK = 1006.0;
inline constexpr double kVapourHeat_J_kgK = 1860.0;
inline constexpr double kWaterHeat_J_kgK = 4186.0;
inline constexpr double kEvaporation_J_kg = 2.501e6;  ///< At 0 degC.
inline constexpr double kSeaLevel_Pa = 101'325.0;

/// Moist air by its two conserved properties; the humidity ratio is kg of water per kg of dry air.
struct AirState {
  double temperature_C;
  double humidity_kg_kg;
};

/// Over liquid water, −20…50 degC, within 0.1 % of the ASHRAE tables.
/// @see Buck (1981), J. Appl. Meteorol. 20, 1527-1532, with the coefficients of 1996.
[[nodiscard]] double saturation_pressure_Pa(double temperature_C);
[[nodiscard]] double saturation_humidity_kg_kg(double temperature_C, double pressure_Pa);

/// Inverse of `saturation_pressure_Pa`. @pre vapour_pressure_Pa > 0
[[nodiscard]] double dew_point_C(double vapour_pressure_Pa);
[[nodiscard]] double vapour_pressure_Pa(double humidity_kg_kg, double pressure_Pa);
[[nodiscard]] double humidity_from_vapour_kg_kg(double vapour_pressure_Pa, double pressure_Pa);

/// 0…1, capped at 1.
[[nodiscard]] double relative_humidity(const AirState& air, double pressure_Pa);

/// Thermodynamic (adiabatic saturation) wet bulb, over liquid water also below 0 degC. For
/// saturated air, its own temperature. @see ASHRAE Handbook Fundamentals, chapter 1
[[nodiscard]] double wet_bulb_C(const AirState& air, double pressure_Pa);

/// Per kg of dry air, zero for dry air at 0 degC.
[[nodiscard]] double enthalpy_J_kg(const AirState& air);
[[nodiscard]] inline double heat_capacity_J_kgK(const AirState& air) {
  return kDryAirHeat_J_kgK + kVapourHeat_J_kgK * air.humidity_kg_kg;
}

/// Of dry air in the mixture, kg/m³.
[[nodiscard]] double density_kg_m3(double temperature_C, double pressure_Pa);

/// Standard atmosphere.
[[nodiscard]] double pressure_at_altitude_Pa(double altitude_m);

/// Adiabatic mixing; `share` is that of the first stream by dry mass, 0…1.
[[nodiscard]] AirState mix(const AirState& first, const AirState& second, double share);

}  // namespace recald::simulators
