/// Moist air, as far as a building energy model needs it.
#pragma once

namespace recald::weather {

inline constexpr double kVaporisationHeat_J_kg = 2.5e6;   ///< h_fg of water near 0…30 °C.
inline constexpr double kAirHeatCapacity_J_kgK = 1005.0;  ///< c_p of dry air.

/// Saturation pressure over water (>= 0 °C) or ice. Within 0.1 % of the tables over −40…60 °C.
/// @see ASHRAE Handbook Fundamentals (2009), chapter 1, eqs. (5) and (6), Hyland and Wexler.
[[nodiscard]] double saturation_pressure_Pa(double temperature_C);

/// kg water per kg dry air. @pre 0 <= relative_humidity <= 1
/// @see ASHRAE Handbook Fundamentals (2009), chapter 1, eqs. (22) and (24).
[[nodiscard]] double humidity_ratio(double temperature_C, double relative_humidity,
                                    double pressure_Pa);

/// Adiabatic saturation with constant h_fg and c_p: within 0.5 K of the chart over 0…40 °C. Never
/// above the dry bulb. @param humidity_ratio  kg/kg
[[nodiscard]] double wet_bulb_C(double dry_bulb_C, double humidity_ratio, double pressure_Pa);

/// Standard-atmosphere pressure. @see the same chapter, eq. (3).
[[nodiscard]] double pressure_at_altitude_Pa(double altitude_m);

/// ρ c_p of air, J/(m³K): 1200 at sea level and 20 °C, scaled with pressure.
[[nodiscard]] double air_heat_capacity_J_m3K(double pressure_Pa);

}  // namespace recald::weather
