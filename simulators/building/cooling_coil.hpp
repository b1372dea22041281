/// A chilled-water coil by apparatus dew point and bypass factor, with limits.
#pragma once

#include "simulators/climate/air.hpp"

namespace recald::simulators {

struct CoolingCoil {
  double capacity_W;                    ///< Largest total heat, set by the valve and the pipe.
  double design_flow_kg_s;              ///< Dry air.
  double design_bypass_factor;          ///< Share of air that leaves untreated at design flow.
  double lowest_apparatus_dew_point_C;  ///< The lowest fin temperature that the chilled water can
                                        ///< maintain.
};

struct CoilWork {
  AirState leaving;
  double total_W;  ///< Heat to the chilled water, >= 0.
  double sensible_W;
  double condensate_kg_s;
};

/// Cools `entering` towards `target_C`. The air leaves warmer if the water is not cold enough or
/// capacity runs out; nothing happens if the air is already cold enough.
///
/// The air leaves on the straight line from its entering state to saturated air at the fins; below
/// its dew point the fins are wet, above them nothing condenses. The bypass factor falls with flow
/// as exp(−NTU), NTU ∝ flow^−0.5.
/// @see McQuiston, Parker, Spitler, "Heating, Ventilating and Air Conditioning", ch. 14 (coil
/// line).
[[nodiscard]] CoilWork cool(const CoolingCoil& coil, const AirState& entering, double flow_kg_s,
                            double target_C, double pressure_Pa);

}  // namespace recald::simulators
