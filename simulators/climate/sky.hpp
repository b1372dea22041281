/// What comes from the sky through clear air and cloud: sunshine and long-wave radiation.
#pragma once

#include "simulators/climate/sun.hpp"

namespace recald::simulators {

/// What stands between the sun and the ground on one occasion.
struct Veil {
  double haze;   ///< Extinction beyond Meinel's air, a unit of air mass; negative is clearer.
  double cloud;  ///< Share of the sky, 0…1.
  double overcast_transmittance;  ///< Of global radiation under a full cover.
};

/// Radiation at the ground. Clear beam after Meinel (1976), Applied Solar Energy, with haze on top;
/// air mass after Kasten, Young (1989), Applied Optics 28(22).
///
/// @param up  sine of the sun's elevation; at or below 0 there is none.
[[nodiscard]] SkyRadiation sky_radiation(double outside_W_m2, double up, const Veil& veil);

/// Temperature of a black sky that radiates as the real one does: clear-sky emissivity after
/// Berdahl, Martin (1984), Solar Energy 32(5), filled up by cloud.
[[nodiscard]] double sky_temperature_C(double air_C, double dew_C, double cloud);

}  // namespace recald::simulators
