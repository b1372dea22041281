#include "simulators/climate/sky.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace recald::simulators {

SkyRadiation sky_radiation(double outside_W_m2, double up, const Veil& veil) {
  if (up <= 0.0) return {0.0, 0.0, outside_W_m2};
  const double elevation_deg = std::asin(std::min(1.0, up)) * 360.0 / (2.0 * std::numbers::pi);
  const double air_mass = 1.0 / (up + 0.50572 * std::pow(elevation_deg + 6.07995, -1.6364));
  const double clear_beam =
      outside_W_m2 * std::pow(0.7, std::pow(air_mass, 0.678)) * std::exp(-veil.haze * air_mass);
  const double clear_diffuse = (0.085 + 0.5 * veil.haze) * outside_W_m2 * std::pow(up, 0.7);
  const double overcast = veil.overcast_transmittance * outside_W_m2 * up;
  // Broken cloud scatters light, so there is more than the two shares of the sky alone would give.
  const double bright_edges = 0.22 * veil.cloud * (1.0 - veil.cloud) * outside_W_m2 * up;
  return {clear_beam * (1.0 - veil.cloud),
          (1.0 - veil.cloud) * clear_diffuse + veil.cloud * overcast + bright_edges, outside_W_m2};
}

double sky_temperature_C(double air_C, double dew_C, double cloud) {
  const double d = dew_C / 100.0;
  const double clear = 0.711 + 0.56 * d + 0.73 * d * d;
  const double emissivity = clear + (1.0 - clear) * 0.84 * cloud;
  return (air_C + 273.15) * std::pow(emissivity, 0.25) - 273.15;
}

}  // namespace recald::simulators
