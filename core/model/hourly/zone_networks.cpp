#include "core/model/hourly/zone_networks.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace recald::model::hourly {
namespace {

constexpr double kAirToSurface_W_m2K = 3.45;   // h_is
constexpr double kSurfaceToMass_W_m2K = 9.1;   // h_ms
constexpr double kInnerSurfacePerFloor = 4.5;  // A_t / A_f
constexpr double kLeastCooling_K = 0.1;        // between supply air and the cooling set-point
// The largest share of the inner surfaces' own conductance that an envelope may use.
constexpr double kMostOfSurfaces = 0.9;

/// A_m / A_f: the table's classes, interpolated so that a capacity can be calibrated.
/// @see ISO 13790:2008, table 12
double mass_surface_per_floor(double capacity_J_m2K) {
  const double medium = heat_capacity_J_m2K(MassClass::medium);
  const double heavy = heat_capacity_J_m2K(MassClass::heavy);
  const double very_heavy = heat_capacity_J_m2K(MassClass::very_heavy);
  return 2.5 + 0.5 * std::clamp((capacity_J_m2K - medium) / (heavy - medium), 0.0, 1.0) +
         0.5 * std::clamp((capacity_J_m2K - heavy) / (very_heavy - heavy), 0.0, 1.0);
}

/// Separates the storeys below the top one from the core, as their own zone: rooms without an outer
/// surface keep their heat all night and are cooled in winter, rooms under a roof are not.
/// @param zones  The last but one is the core, the last is overwritten.
void cut_core(int storeys, std::span<Zone> zones) {
  Zone& top = zones[zones.size() - 2];
  Zone& inner = zones.back();
  const double top_share = 1.0 / storeys;
  inner.floor_share = (1.0 - top_share) * top.floor_share;
  top.floor_share *= top_share;
  inner.ground_W_K = std::exchange(top.ground_W_K, 0.0);
  inner.transmission_W_K = inner.sky_loss_W = inner.leakage_cm2 = 0.0;
  std::ranges::fill(inner.solar_aperture_m2, 0.0);
}

}  // namespace

ZoneConductances zone_conductances(const Building& building, const Zone& zone, double window_W_K) {
  const double opaque_W_K = std::max(zone.transmission_W_K - window_W_K, 0.0);
  const double heavy_W_K = opaque_W_K + zone.ground_W_K;  // what passes through the mass
  const double mass_per_floor = mass_surface_per_floor(building.heat_capacity_J_m2K);
  const double coupling_W_m2K = building.mass_coupling * kSurfaceToMass_W_m2K;
  const double floor_m2 = std::max({zone.floor_share * building.floor_area_m2,
                                    heavy_W_K / (kMostOfSurfaces * coupling_W_m2K * mass_per_floor),
                                    window_W_K / (kMostOfSurfaces * kSurfaceToMass_W_m2K *
                                                  (kInnerSurfacePerFloor - mass_per_floor)),
                                    1.0});
  const double mass_m2 = mass_per_floor * floor_m2;
  const double surface_m2 = kInnerSurfacePerFloor * floor_m2;
  const double to_mass_W_K = coupling_W_m2K * mass_m2;
  // H_em = 1 / (1/H_op - 1/H_ms), in a form that stays finite without an envelope; the ground has
  // its share of the same path.
  const double stretch = 1.0 / (1.0 - heavy_W_K / to_mass_W_K);
  return {.air_to_surface_W_K = kAirToSurface_W_m2K * surface_m2,
          .surface_to_mass_W_K = to_mass_W_K,
          .surface_to_outdoor_W_K = window_W_K,
          .mass_to_outdoor_W_K = stretch * opaque_W_K,
          .mass_to_ground_W_K = stretch * zone.ground_W_K,
          .mass_share = mass_m2 / surface_m2,
          .surface_share =
              1.0 - mass_m2 / surface_m2 - window_W_K / (kSurfaceToMass_W_m2K * surface_m2),
          .capacity_J_K = floor_m2 * building.heat_capacity_J_m2K};
}

/// With S_m = K θ_m⁻ + H_em θ_e + H_g θ_g + Φ_m and K = 2 C_m / Δt the three balances are
///     θ_m = G (S_m + H_ms θ_s),                        G = 1 / (K + H_em + H_g + H_ms)
///     θ_s = (t S_m + H_w θ_e + Φ_st + H_is θ_air) / D,  t = H_ms G,  D = H_ms (1 - t) + H_w + H_is
///     Y θ_air = p (t S_m + H_w θ_e + Φ_st) + Φ_ia + …,  p = H_is / D,  Y = H_is (1 - p)
/// and θ_m⁺ = 2 θ_m - θ_m⁻ with θ_m = v S_m + u (H_w θ_e + Φ_st + H_is θ_air), u = t / D,
/// v = G + u t.
void ZoneNetworks::set_coefficients(const ZoneConductances& c, double step_s, int place,
                                    Pair& pair) {
  const double K = 2.0 * c.capacity_J_K / step_s;
  const double G = 1.0 / (K + c.mass_to_outdoor_W_K + c.mass_to_ground_W_K + c.surface_to_mass_W_K);
  const double t = c.surface_to_mass_W_K * G;
  const double D =
      c.surface_to_mass_W_K * (1.0 - t) + c.surface_to_outdoor_W_K + c.air_to_surface_W_K;
  const double p = c.air_to_surface_W_K / D;
  const double u = t / D;
  const double v = G + u * t;

  pair.air_W_K[place] = c.air_to_surface_W_K * (1.0 - p);
  pair.air_from_mass[place] = p * t * K;
  pair.air_from_outdoor[place] = p * (t * c.mass_to_outdoor_W_K + c.surface_to_outdoor_W_K);
  pair.air_from_ground[place] = p * t * c.mass_to_ground_W_K;
  pair.air_from_solar[place] = p * (t * c.mass_share + c.surface_share);
  pair.air_from_internal[place] =
      0.5 * pair.air_from_solar[place] + 0.5;  // Φ_ia: half goes to the air

  pair.mass_from_mass[place] = 2.0 * v * K - 1.0;
  pair.mass_from_outdoor[place] = 2.0 * (v * c.mass_to_outdoor_W_K + u * c.surface_to_outdoor_W_K);
  pair.mass_from_ground[place] = 2.0 * v * c.mass_to_ground_W_K;
  pair.mass_from_solar[place] = 2.0 * (v * c.mass_share + u * c.surface_share);
  pair.mass_from_internal[place] = 0.5 * pair.mass_from_solar[place];
  pair.mass_from_air[place] = 2.0 * u * c.air_to_surface_W_K;
}

void ZoneNetworks::describe(const Building& building,
                            std::span<const weather::Orientation> orientations, double step_s,
                            int parts) {
  const std::size_t described = zone_count(building, orientations);
  const bool cut = described > 1 && building.storeys > 1;
  const std::size_t n = described + (cut ? 1 : 0);
  zones_.resize(n);
  glazing_.resize(n);
  for (Zone& zone : zones_) zone.solar_aperture_m2.resize(orientations.size());
  for (Zone& zone : glazing_) zone.solar_aperture_m2.resize(orientations.size());
  describe_zones(building, orientations, std::span{zones_}.first(described));
  if (cut) cut_core(building.storeys, zones_);
  windows_only_ = building;
  for (Surface& surface : windows_only_.surfaces) {
    if (surface.kind != SurfaceKind::window) surface.u_W_m2K = 0.0;
  }
  describe_zones(windows_only_, orientations, std::span{glazing_}.first(described));
  if (cut) cut_core(building.storeys, glazing_);

  const std::size_t count = (n + 1) / 2;
  pairs_.resize(count);
  mass_C_.resize(count * static_cast<std::size_t>(parts));
  air_C_.resize(mass_C_.size());
  air_store_W_K_ = building.air_capacity_J_m2K * building.floor_area_m2 / step_s;
  to_air_W_.resize(count);
  to_mass_K_.resize(count);
  aperture_m2_.assign(count * orientations.size(), ZonePair::Zero());
  for (std::size_t z = 0; z < 2 * count; ++z) {
    // An odd last zone is paired with a copy of it that has no weight and no sun.
    const bool real = z < n;
    const std::size_t like = std::min(z, n - 1);
    const int place = static_cast<int>(z % 2);
    Pair& pair = pairs_[z / 2];
    pair.counts[place] = real ? 1.0 : 0.0;
    pair.floor_share[place] = real ? zones_[like].floor_share : 0.0;
    pair.gain_share[place] = real ? gain_share(building, like, described - 1) : 0.0;
    pair.leakage_cm2[place] = zones_[like].leakage_cm2;
    pair.sky_loss_W[place] = zones_[like].sky_loss_W;
    ZoneConductances conductances =
        zone_conductances(building, zones_[like], glazing_[like].transmission_W_K);
    if (described > 1 && like + 1 >= described) {
      conductances.capacity_J_K *= building.core_mass_share;
    }
    set_coefficients(conductances, step_s, place, pair);
    for (std::size_t k = 0; real && k < orientations.size(); ++k) {
      aperture_m2_[z / 2 * orientations.size() + k][place] = zones_[like].solar_aperture_m2[k];
    }
  }
}

double ZoneNetworks::gain_share(const Building& building, std::size_t zone,
                                std::size_t first_core) const {
  const double even = zones_[zone].floor_share;
  if (first_core == 0) return even;
  double core_share = 0.0;
  for (std::size_t z = first_core; z < zones_.size(); ++z) core_share += zones_[z].floor_share;
  const double moved = building.use.gains_to_core;
  return zone < first_core ? (1.0 - moved) * even
                           : even * (1.0 + moved * (1.0 - core_share) / core_share);
}

void ZoneNetworks::reset(double mass_C) {
  std::ranges::fill(mass_C_, ZonePair::Constant(mass_C));
  std::ranges::fill(air_C_, ZonePair::Constant(mass_C));
}

double ZoneNetworks::mass_C(int part, std::size_t zone) const {
  return mass_C_[static_cast<std::size_t>(part) * pairs_.size() + zone / 2]
                [static_cast<int>(zone % 2)];
}

void ZoneNetworks::expose(const ZoneSurroundings& s) {
  dry_bulb_C_ = s.dry_bulb_C;
  const std::size_t sides = s.irradiance_W_m2.size();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& z = pairs_[i];
    ZonePair solar_W = -z.sky_loss_W;
    for (std::size_t k = 0; k < sides; ++k) {
      solar_W += aperture_m2_[i * sides + k] * (s.solar_share * s.irradiance_W_m2[k]);
    }
    const ZonePair internal_W = z.gain_share * s.internal_W;
    to_air_W_[i] = z.air_from_outdoor * s.dry_bulb_C + z.air_from_ground * s.ground_C +
                   z.air_from_solar * solar_W + z.air_from_internal * internal_W;
    to_mass_K_[i] = z.mass_from_outdoor * s.dry_bulb_C + z.mass_from_ground * s.ground_C +
                    z.mass_from_solar * solar_W + z.mass_from_internal * internal_W;
  }
}

ZoneTotals ZoneNetworks::serve_with_boxes(int part, const ZoneService& s) {
  const double per_lift_K = 1.0 / std::max(s.cooling_C - s.supply_C, kLeastCooling_K);
  ZonePair heating_W = ZonePair::Zero();
  ZonePair all_heat_W = ZonePair::Zero();
  ZonePair scheduled_W_K = ZonePair::Zero();
  ZonePair scheduled_W = ZonePair::Zero();
  ZonePair all_W_K = ZonePair::Zero();
  ZonePair all_W = ZonePair::Zero();
  ZonePair air_C_sum = ZonePair::Zero();
  ZonePair* mass_C = mass_C_.data() + static_cast<std::size_t>(part) * pairs_.size();
  ZonePair* last_air_C = air_C_.data() + static_cast<std::size_t>(part) * pairs_.size();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& z = pairs_[i];
    const ZonePair outdoor_W_K = z.leakage_cm2 * s.leakage_W_K_cm2 + z.floor_share * s.outdoor_W_K;
    const ZonePair store_W_K = z.floor_share * air_store_W_K_;
    const ZonePair lost_W_K = z.air_W_K + outdoor_W_K + store_W_K;
    const ZonePair source_W = to_air_W_[i] + z.air_from_mass * mass_C[i] +
                              outdoor_W_K * dry_bulb_C_ + store_W_K * last_air_C[i];
    const ZonePair most_W_K = z.floor_share * s.most_W_K;
    const ZonePair flow_W_K = ((source_W - lost_W_K * s.cooling_C) * per_lift_K)
                                  .max(z.floor_share * s.least_W_K)
                                  .min(most_W_K);
    const ZonePair total_W_K = lost_W_K + flow_W_K;
    const ZonePair total_W = source_W + flow_W_K * s.supply_C;
    const ZonePair air_C = (total_W / total_W_K).max(s.heating_C);
    const ZonePair heat_W = z.counts * (total_W_K * s.heating_C - total_W).max(0.0);
    last_air_C[i] = air_C;
    mass_C[i] = to_mass_K_[i] + z.mass_from_mass * mass_C[i] + z.mass_from_air * air_C;

    const ZonePair by_schedule_W_K = flow_W_K.min(most_W_K * s.scheduled_share);
    all_heat_W += heat_W;
    heating_W += (lost_W_K * s.heating_C - source_W).max(0.0).min(heat_W);
    scheduled_W_K += by_schedule_W_K;
    scheduled_W += by_schedule_W_K * air_C;
    all_W_K += flow_W_K;
    all_W += flow_W_K * air_C;
    air_C_sum += z.floor_share * air_C;
  }
  ZoneTotals totals;
  totals.zone_heating_W = heating_W.sum();
  totals.reheat_W = all_heat_W.sum() - totals.zone_heating_W;
  totals.scheduled_W_K = scheduled_W_K.sum();
  totals.scheduled_return_W = scheduled_W.sum();
  totals.on_call_W_K = all_W_K.sum() - totals.scheduled_W_K;
  totals.on_call_return_W = all_W.sum() - totals.scheduled_return_W;
  totals.mean_air_C = air_C_sum.sum();
  return totals;
}

ZoneTotals ZoneNetworks::serve(int part, const ZoneService& s) {
  ZonePair heat_W = ZonePair::Zero();
  ZonePair cold_W = ZonePair::Zero();
  ZonePair air_C_sum = ZonePair::Zero();
  ZonePair* mass_C = mass_C_.data() + static_cast<std::size_t>(part) * pairs_.size();
  ZonePair* last_air_C = air_C_.data() + static_cast<std::size_t>(part) * pairs_.size();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& z = pairs_[i];
    const ZonePair outdoor_W_K = z.leakage_cm2 * s.leakage_W_K_cm2 + z.floor_share * s.outdoor_W_K;
    const ZonePair store_W_K = z.floor_share * air_store_W_K_;
    const ZonePair lost_W_K = z.air_W_K + outdoor_W_K + store_W_K;
    const ZonePair source_W = to_air_W_[i] + z.air_from_mass * mass_C[i] +
                              outdoor_W_K * dry_bulb_C_ + store_W_K * last_air_C[i] +
                              z.floor_share * s.fan_W;
    const ZonePair air_C = (source_W / lost_W_K).max(s.heating_C).min(s.cooling_C);
    last_air_C[i] = air_C;
    mass_C[i] = to_mass_K_[i] + z.mass_from_mass * mass_C[i] + z.mass_from_air * air_C;
    heat_W += z.counts * (lost_W_K * s.heating_C - source_W).max(0.0);
    cold_W += z.counts * (source_W - lost_W_K * s.cooling_C).max(0.0);
    air_C_sum += z.floor_share * air_C;
  }
  ZoneTotals totals;
  totals.zone_heating_W = heat_W.sum();
  totals.cooling_W = cold_W.sum();
  totals.mean_air_C = air_C_sum.sum();
  return totals;
}

}  // namespace recald::model::hourly
