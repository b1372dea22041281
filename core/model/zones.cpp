#include "core/model/zones.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace recald::model {
namespace {

constexpr double kNonPerpendicular = 0.9;          // F_w, glazing seen at an angle
constexpr double kSurfaceResistance_m2K_W = 0.04;  // R_se
constexpr double kSkyDifference_K = 11.0;          // Δθ_er, intermediate climates
constexpr std::array<double, 3> kWindByStoreys = {1.74e-4, 2.31e-4, 2.71e-4};
// The core's share if façades claim more floor than there is.
constexpr double kLeastCoreShare = 0.05;

bool is_facade(const weather::Orientation& orientation) { return orientation.tilt_deg >= 45.0; }

double solar_aperture_m2(const Surface& s) {
  if (s.kind == SurfaceKind::window) {
    return s.shading_factor * s.shgc * kNonPerpendicular * (1.0 - s.frame_fraction) * s.area_m2;
  }
  return s.solar_absorptance * kSurfaceResistance_m2K_W * s.u_W_m2K * s.area_m2;
}

double sky_loss_W(const Surface& s) {
  const double sky_view = is_facade(s.orientation) ? 0.5 : 1.0;  // F_r
  const double radiative_W_m2K = 5.0 * s.emissivity;             // h_r
  return sky_view * kSurfaceResistance_m2K_W * s.u_W_m2K * s.area_m2 * radiative_W_m2K *
         kSkyDifference_K;
}

/// Floor behind one façade on all storeys; neighbouring façades share the corners equally.
double perimeter_floor_m2(const Building& building, const weather::Orientation& orientation) {
  double facade_m2 = 0.0;
  for (const Surface& s : building.surfaces) {
    if (s.kind != SurfaceKind::ground && s.orientation == orientation) facade_m2 += s.area_m2;
  }
  const double length_m = facade_m2 / (building.storeys * building.storey_height_m);
  return kPerimeterDepth_m * std::max(length_m - kPerimeterDepth_m, 0.0) * building.storeys;
}

void add_surface(const Building& building, const Surface& surface, std::size_t orientation,
                 double share, Zone& zone) {
  const double conductance_W_K = share * surface.u_W_m2K * surface.area_m2;
  if (surface.kind == SurfaceKind::ground) {
    zone.ground_W_K += conductance_W_K;
    return;
  }
  zone.transmission_W_K += conductance_W_K;
  zone.sky_loss_W += share * sky_loss_W(surface);
  zone.leakage_cm2 += share * building.leakage_cm2_m2 * surface.area_m2;
  zone.solar_aperture_m2[orientation] += share * solar_aperture_m2(surface);
}

void share_floor(const Building& building, std::span<const weather::Orientation> orientations,
                 std::span<Zone> zones) {
  double perimeter_share = 0.0;
  std::size_t next = 0;
  for (const weather::Orientation& orientation : orientations) {
    if (!is_facade(orientation)) continue;
    zones[next].floor_share = perimeter_floor_m2(building, orientation) / building.floor_area_m2;
    perimeter_share += zones[next++].floor_share;
  }
  const double shrink = std::min(1.0, (1.0 - kLeastCoreShare) / std::max(perimeter_share, 1e-9));
  for (Zone& zone : zones.first(next)) zone.floor_share *= shrink;
  zones.back().floor_share = 1.0 - shrink * perimeter_share;
}

}  // namespace

double LeakageFlow::per_area_m3_s(double temperature_difference_K, double wind2_m2_s2) const {
  return 1e-3 * std::sqrt(stack_coefficient * std::abs(temperature_difference_K) +
                          wind_coefficient * wind2_m2_s2);
}

LeakageFlow leakage_flow(int storeys) {
  const int tabled = std::clamp(storeys, 1, 3);  // the tables end at three
  return {1.45e-4 * tabled, kWindByStoreys[static_cast<std::size_t>(tabled - 1)]};
}

std::size_t zone_count(const Building& building,
                       std::span<const weather::Orientation> orientations) {
  if (!building.air) return 1;
  return static_cast<std::size_t>(std::ranges::count_if(orientations, is_facade)) + 1;
}

void describe_zones(const Building& building, std::span<const weather::Orientation> orientations,
                    std::span<Zone> zones) {
  assert(zones.size() == zone_count(building, orientations));
  for (Zone& zone : zones) {
    zone.floor_share = 1.0;
    zone.transmission_W_K = zone.ground_W_K = zone.sky_loss_W = zone.leakage_cm2 = 0.0;
    std::ranges::fill(zone.solar_aperture_m2, 0.0);
  }
  if (zones.size() > 1) share_floor(building, orientations, zones);

  for (const Surface& surface : building.surfaces) {
    const auto facing = std::ranges::find(orientations, surface.orientation);
    const auto orientation = static_cast<std::size_t>(facing - orientations.begin());
    const bool shared = surface.kind == SurfaceKind::ground || !is_facade(surface.orientation);
    if (zones.size() == 1 || shared) {
      for (Zone& zone : zones) {
        add_surface(building, surface, orientation, zone.floor_share, zone);
      }
    } else {
      const auto zone =
          static_cast<std::size_t>(std::count_if(orientations.begin(), facing, is_facade));
      add_surface(building, surface, orientation, 1.0, zones[zone]);
    }
  }
}

}  // namespace recald::model
