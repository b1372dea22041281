#include "core/weather/sun.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace recald::weather {
namespace {

constexpr double kRadian = std::numbers::pi / 180.0;
constexpr double kSolarConstant_W_m2 = 1367.0;
constexpr double kGroundAlbedo = 0.2;
// Beam from a sun lower than this is more error than energy: it divides by nearly nothing.
constexpr double kLowestCosZenith = 0.05;

/// Angle of the day in the year, Spencer's B.
double day_angle(metering::Instant instant) {
  const auto midnight = std::chrono::floor<std::chrono::days>(instant);
  const auto year = metering::Day{midnight}.year();
  const auto new_year = std::chrono::sys_days{year / 1 / 1};
  return 2.0 * std::numbers::pi * static_cast<double>((midnight - new_year).count()) / 365.0;
}

double declination_rad(double b) {
  return 0.006918 - 0.399912 * std::cos(b) + 0.070257 * std::sin(b) - 0.006758 * std::cos(2 * b) +
         0.000907 * std::sin(2 * b) - 0.002697 * std::cos(3 * b) + 0.00148 * std::sin(3 * b);
}

double equation_of_time_min(double b) {
  return 229.2 * (0.000075 + 0.001868 * std::cos(b) - 0.032077 * std::sin(b) -
                  0.014615 * std::cos(2 * b) - 0.04089 * std::sin(2 * b));
}

}  // namespace

SunPosition sun_position(metering::Instant instant, const Location& location) {
  const double b = day_angle(instant);
  const double declination = declination_rad(b);
  const double latitude = location.latitude_deg * kRadian;
  const auto since_midnight = instant - std::chrono::floor<std::chrono::days>(instant);
  const double solar_minutes = static_cast<double>(since_midnight.count()) / 60.0 +
                               4.0 * location.longitude_deg + equation_of_time_min(b);
  const double hour_angle = (solar_minutes / 4.0 - 180.0) * kRadian;

  const double cos_zenith = std::sin(latitude) * std::sin(declination) +
                            std::cos(latitude) * std::cos(declination) * std::cos(hour_angle);
  // East, north components of the direction to the sun.
  const double east = -std::cos(declination) * std::sin(hour_angle);
  const double north = std::cos(latitude) * std::sin(declination) -
                       std::sin(latitude) * std::cos(declination) * std::cos(hour_angle);
  const double azimuth_deg = std::atan2(east, north) / kRadian;
  return {cos_zenith, azimuth_deg < 0.0 ? azimuth_deg + 360.0 : azimuth_deg};
}

double extraterrestrial_W_m2(const SunPosition& sun, metering::Instant instant) {
  return kSolarConstant_W_m2 * (1.0 + 0.033 * std::cos(day_angle(instant))) *
         std::max(sun.cos_zenith, 0.0);
}

double clear_sky_W_m2(const SunPosition& sun) {
  if (sun.cos_zenith <= 0.0) return 0.0;
  return 1098.0 * sun.cos_zenith * std::exp(-0.057 / sun.cos_zenith);
}

SplitIrradiance split_global_horizontal(double global_horizontal_W_m2, const SunPosition& sun,
                                        metering::Instant instant) {
  if (global_horizontal_W_m2 <= 0.0) return {0.0, 0.0};
  if (sun.cos_zenith < kLowestCosZenith) return {0.0, global_horizontal_W_m2};
  const double kt = std::min(global_horizontal_W_m2 / extraterrestrial_W_m2(sun, instant), 1.0);
  double diffuse_share = 0.165;
  if (kt <= 0.22) {
    diffuse_share = 1.0 - 0.09 * kt;
  } else if (kt <= 0.80) {
    diffuse_share = 0.9511 + kt * (-0.1604 + kt * (4.388 + kt * (-16.638 + kt * 12.336)));
  }
  const double diffuse_W_m2 = diffuse_share * global_horizontal_W_m2;
  return {(global_horizontal_W_m2 - diffuse_W_m2) / sun.cos_zenith, diffuse_W_m2};
}

double irradiance_on_W_m2(const Orientation& surface, const SplitIrradiance& sky,
                          double global_horizontal_W_m2, const SunPosition& sun) {
  const double tilt = surface.tilt_deg * kRadian;
  const double sin_zenith = std::sqrt(std::max(0.0, 1.0 - sun.cos_zenith * sun.cos_zenith));
  const double cos_incidence =
      sun.cos_zenith * std::cos(tilt) +
      sin_zenith * std::sin(tilt) * std::cos((sun.azimuth_deg - surface.azimuth_deg) * kRadian);
  return sky.direct_normal_W_m2 * std::max(cos_incidence, 0.0) +
         sky.diffuse_horizontal_W_m2 * 0.5 * (1.0 + std::cos(tilt)) +
         global_horizontal_W_m2 * kGroundAlbedo * 0.5 * (1.0 - std::cos(tilt));
}

}  // namespace recald::weather
