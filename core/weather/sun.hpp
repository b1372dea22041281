/// Where the sun stands and how much of it a surface sees.
#pragma once

#include "core/metering/civil_time.hpp"

namespace recald::weather {

struct Location {
  double latitude_deg;   ///< North positive.
  double longitude_deg;  ///< East positive.
  double altitude_m = 0.0;
};

struct SunPosition {
  double cos_zenith;   ///< Negative below the horizon.
  double azimuth_deg;  ///< From north, clockwise.
};

/// @see Spencer (1971), Search 2(5), as printed in Duffie and Beckman, 4th ed., eqs. (1.4.2),
///      (1.5.3), (1.6.1b), (1.6.5). Within 0.5° of an almanac.
[[nodiscard]] SunPosition sun_position(metering::Instant instant, const Location& location);

/// Irradiance on a horizontal plane above the atmosphere; 0 below the horizon.
/// @see Duffie and Beckman, 4th ed., eq. (1.10.2), with the distance to the sun of eq. (1.4.1a).
[[nodiscard]] double extraterrestrial_W_m2(const SunPosition& sun, metering::Instant instant);

/// Global horizontal irradiance of a cloudless sky; 0 below the horizon. By the sun's height alone.
/// @see Haurwitz (1945), J. Meteorology 2, as printed in Reno, Hansen, Stein (2012), SAND2012-2389.
[[nodiscard]] double clear_sky_W_m2(const SunPosition& sun);

struct SplitIrradiance {
  double direct_normal_W_m2;
  double diffuse_horizontal_W_m2;
};

/// Splits global horizontal irradiance into beam and diffuse by the clearness of the sky.
/// @see Erbs, Klein, Duffie (1982), Solar Energy 28(4), eq. (1).
[[nodiscard]] SplitIrradiance split_global_horizontal(double global_horizontal_W_m2,
                                                      const SunPosition& sun,
                                                      metering::Instant instant);

/// Which way a surface faces: tilt 0 is a flat roof, 90 a wall.
struct Orientation {
  double azimuth_deg = 0.0;
  double tilt_deg = 90.0;
  bool operator==(const Orientation&) const = default;
};

/// Irradiance on a tilted plane, isotropic sky (Liu and Jordan), ground albedo 0.2.
[[nodiscard]] double irradiance_on_W_m2(const Orientation& surface, const SplitIrradiance& sky,
                                        double global_horizontal_W_m2, const SunPosition& sun);

}  // namespace recald::weather
