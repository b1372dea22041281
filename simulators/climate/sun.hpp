/// The sun's position and the radiation on tilted surfaces, for the simulators alone.
#pragma once

#include "core/metering/civil_time.hpp"

namespace recald::simulators {

struct Place {
  double latitude_deg;   ///< North positive.
  double longitude_deg;  ///< East positive.
  double altitude_m;
};

/// Geometric (no refraction). The direction is a unit vector towards the sun: east, north, up.
struct SunPosition {
  double east;
  double north;
  double up;  ///< Sine of the elevation.

  [[nodiscard]] double elevation_deg() const;
  [[nodiscard]] double azimuth_deg() const;  ///< From north clockwise, 0…360.
};

/// Low-precision Astronomical Almanac, within 0.02 degrees for 1950-2050.
/// @see Michalsky (1988), Solar Energy 40(3), 227-235.
[[nodiscard]] SunPosition sun_position(metering::Instant t, const Place& place);

/// Beam normal radiation outside the atmosphere on this day, W/m².
[[nodiscard]] double extraterrestrial_W_m2(metering::Instant t);

/// A plane's outward normal: azimuth from north clockwise, tilt 0 facing up, 90 vertical.
struct Orientation {
  double azimuth_deg;
  double tilt_deg;
};

/// Radiation on a plane by its path.
struct Irradiance {
  double beam_W_m2;
  double diffuse_W_m2;      ///< From sky and ground.
  double cosine_incidence;  ///< Of the beam; 0 when the sun is behind the plane.

  [[nodiscard]] double total_W_m2() const { return beam_W_m2 + diffuse_W_m2; }
};

struct SkyRadiation {
  double beam_normal_W_m2;
  double diffuse_horizontal_W_m2;
  double extraterrestrial_normal_W_m2;
};

/// Circumsolar plus isotropic sky plus isotropic ground.
/// @see Hay, Davies (1980), Proc. First Canadian Solar Radiation Data Workshop.
[[nodiscard]] Irradiance irradiance_on(const Orientation& plane, const SunPosition& sun,
                                       const SkyRadiation& sky, double ground_reflectance);

/// Transmittance of glazing at this angle relative to normal incidence (ASHRAE incidence angle
/// modifier 1 − b0 (1/cos θ − 1)), 0…1.
[[nodiscard]] double glazing_angle_factor(double cosine_incidence);

}  // namespace recald::simulators
