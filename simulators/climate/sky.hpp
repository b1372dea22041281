/// Radiation from the sky through clear air and cloud: sunshine and long-wave radiation.
#pragma once

#include "simulators/climate/sun.hpp"

namespace recald::simulators {

/// Haze and cloud between the sun and the ground.
struct Veil {
  double haze;   ///< Extinction beyond Meinel's air per unit of air mass; negative: clearer.
  double cloud;  ///< Share of the sky, 0…1.
  double overcast_transmittance;  ///< Of global radiation under full cloud cover.
};

/// Radiation at the ground. Clear beam after Meinel (1976), Applied Solar Energy, with haze added;
/// air mass after Kasten, Young (1989), Applied Optics 28(22).
///
/// @param up  Sine of the sun's elevation; at or below 0 there is no radiation.
[[nodiscard]] SkyRadiation sky_radiation(double outside_W_m2, double up, const Veil& veil);

/// Temperature of a black sky with the same radiation as the real one: clear-sky emissivity after
/// Berdahl, Martin (1984), Solar Energy 32(5), raised by cloud.
[[nodiscard]] double sky_temperature_C(double air_C, double dew_C, double cloud);

}  // namespace recald::simulators
