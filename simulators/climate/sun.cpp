#include "simulators/climate/sun.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace recald::simulators {
namespace {

constexpr double kRadian = std::numbers::pi / 180.0;
constexpr double kSolarConstant_W_m2 = 1361.0;

/// Days since 2000-01-01 12:00 UTC, the epoch of the almanac's series.
double days_since_j2000(metering::Instant t) {
  constexpr double unix_days_of_j2000 = 10'957.5;
  return static_cast<double>(t.time_since_epoch().count()) / 86'400.0 - unix_days_of_j2000;
}

double mean_anomaly_rad(double since_days) { return (357.528 + 0.9856003 * since_days) * kRadian; }

}  // namespace

double SunPosition::elevation_deg() const { return std::asin(std::clamp(up, -1.0, 1.0)) / kRadian; }

double SunPosition::azimuth_deg() const {
  const double azimuth = std::atan2(east, north) / kRadian;
  return azimuth < 0.0 ? azimuth + 360.0 : azimuth;
}

SunPosition sun_position(metering::Instant t, const Place& place) {
  const double j2000_days = days_since_j2000(t);
  const double anomaly = mean_anomaly_rad(j2000_days);
  const double mean_longitude_deg = 280.460 + 0.9856474 * j2000_days;
  const double ecliptic_longitude =
      (mean_longitude_deg + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2.0 * anomaly)) * kRadian;
  const double obliquity = (23.439 - 4e-7 * j2000_days) * kRadian;

  // Keep right ascension and declination as vector components, which avoids quadrant errors.
  const double x = std::cos(ecliptic_longitude);
  const double y = std::cos(obliquity) * std::sin(ecliptic_longitude);
  const double z = std::sin(obliquity) * std::sin(ecliptic_longitude);

  const double day_start = std::floor(j2000_days + 0.5) - 0.5;
  const double utc_hours = (j2000_days - day_start) * 24.0;
  const double sidereal_hours = 6.697375 + 0.0657098242 * j2000_days + utc_hours;
  const double local_sidereal = (sidereal_hours * 15.0 + place.longitude_deg) * kRadian;

  // Rotate about the pole to the local meridian, then tip the pole to the latitude.
  const double towards_meridian = x * std::cos(local_sidereal) + y * std::sin(local_sidereal);
  const double towards_east = -x * std::sin(local_sidereal) + y * std::cos(local_sidereal);
  const double latitude = place.latitude_deg * kRadian;
  return {towards_east, z * std::cos(latitude) - towards_meridian * std::sin(latitude),
          z * std::sin(latitude) + towards_meridian * std::cos(latitude)};
}

double extraterrestrial_W_m2(metering::Instant t) {
  const double anomaly = mean_anomaly_rad(days_since_j2000(t));
  const double distance_au =
      1.00014 - 0.01671 * std::cos(anomaly) - 0.00014 * std::cos(2.0 * anomaly);
  return kSolarConstant_W_m2 / (distance_au * distance_au);
}

Irradiance irradiance_on(const Orientation& plane, const SunPosition& sun, const SkyRadiation& sky,
                         double ground_reflectance) {
  const double azimuth = plane.azimuth_deg * kRadian;
  const double tilt = plane.tilt_deg * kRadian;
  const double cosine = std::max(
      0.0, std::sin(tilt) * (std::sin(azimuth) * sun.east + std::cos(azimuth) * sun.north) +
               std::cos(tilt) * sun.up);
  const double sine_elevation = std::max(0.0, sun.up);

  // Near the horizon the ratio of cosines diverges although the energy does not: limit it at 3 deg.
  const double anisotropy = sky.extraterrestrial_normal_W_m2 > 0.0
                                ? sky.beam_normal_W_m2 / sky.extraterrestrial_normal_W_m2
                                : 0.0;
  const double sky_view = 0.5 * (1.0 + std::cos(tilt));
  const double circumsolar = anisotropy * cosine / std::max(sine_elevation, 0.0523);
  const double global_W_m2 = sky.beam_normal_W_m2 * sine_elevation + sky.diffuse_horizontal_W_m2;
  const double ground_W_m2 = 0.5 * (1.0 - std::cos(tilt)) * ground_reflectance * global_W_m2;
  return {sky.beam_normal_W_m2 * (sine_elevation > 0.0 ? cosine : 0.0),
          sky.diffuse_horizontal_W_m2 * (circumsolar + (1.0 - anisotropy) * sky_view) + ground_W_m2,
          cosine};
}

double glazing_angle_factor(double cosine_incidence) {
  constexpr double double_pane_b0 = 0.18;
  if (cosine_incidence <= 0.0) return 0.0;
  return std::clamp(1.0 - double_pane_b0 * (1.0 / cosine_incidence - 1.0), 0.0, 1.0);
}

}  // namespace recald::simulators
