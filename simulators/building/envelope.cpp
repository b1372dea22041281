#include "simulators/building/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace recald::simulators {
namespace {

constexpr double kOutdoorRadiation_W_m2K = 5.0;  ///< Linearised long-wave exchange outdoors.
constexpr double kGroundReflectance = 0.2;
constexpr double kIndoorFilm_W_m2K = 8.1;  ///< As in the zones: convection plus radiation.
constexpr double kTerrainFactor = 0.55;  ///< Wind at the building relative to the weather station.
constexpr double kSpecialWall_m = 60.0;  ///< Walls around special rooms of
constexpr double kSpecialWallFor_m2 = 0.3 * (53.0 * 28.0);  ///< this area: two blocks.
constexpr double kDischarge = 0.6;                          ///< Of a sharp-edged opening.

/// The first two surfaces of every zone are its floor and its ceiling.
constexpr std::size_t kFloor = 0;
constexpr std::size_t kCeiling = 1;
/// Partitions follow: the perimeter and the special rooms have one, to the core; the core has five,
/// to them, in `kAroundCore` order.
constexpr std::size_t kPartition = 2;
constexpr std::array<std::size_t, 5> kAroundCore{south, north, east, west, special};

std::vector<Layer> with_mass(std::vector<Layer> layers, double mass_scale) {
  for (Layer& layer : layers) layer.heat_capacity_J_m3K *= mass_scale;
  return layers;
}

std::vector<Layer> exterior_wall(const Truth& truth) {
  std::vector<Layer> layers;
  if (truth.drawings.heavy) {
    layers = {{0.10, 0.80, 1.50e6, 2},    // brick
              {0.05, 0.035, 4.0e4, 2},    // insulation
              {0.15, 0.90, 1.60e6, 3},    // concrete block
              {0.015, 0.20, 0.80e6, 1}};  // gypsum board
  } else {
    layers = {{0.012, 0.35, 1.40e6, 1},   // fibre-cement panel
              {0.05, 0.035, 4.0e4, 3},    // insulation between studs
              {0.025, 0.20, 0.80e6, 2}};  // gypsum board, twice
  }
  set_u_value(layers, 1, truth.wall_u_W_m2K);
  return with_mass(layers, truth.mass_scale);
}

std::vector<Layer> flat_roof(const Truth& truth) {
  std::vector<Layer> layers{{0.02, 0.20, 1.6e6, 1},   // membrane and ballast
                            {0.10, 0.035, 4.0e4, 2},  // insulation
                            truth.drawings.heavy ? Layer{0.18, 1.60, 2.1e6, 4}    // concrete
                                                 : Layer{0.05, 1.60, 2.1e6, 2}};  // steel deck
  set_u_value(layers, 1, truth.roof_u_W_m2K);
  return with_mass(layers, truth.mass_scale);
}

std::vector<Layer> slab_on_ground(const Truth& truth) {
  std::vector<Layer> layers{{1.00, 1.30, 1.8e6, 4},   // soil that responds within the year
                            {0.05, 0.035, 4.0e4, 1},  // insulation
                            {0.18, 1.60, 2.1e6, 4}};
  set_u_value(layers, 1, truth.ground_u_W_m2K);
  layers[2].heat_capacity_J_m3K *= truth.mass_scale;  // the soil does not scale
  return layers;
}

std::vector<Layer> half_slab(const Truth& truth) {
  const double thickness_m = truth.drawings.heavy ? 0.10 : 0.05;
  return with_mass({{thickness_m, 1.60, 2.1e6, 3}}, truth.mass_scale);
}

std::vector<Layer> half_partition(const Truth& truth) {
  return with_mass({{0.025, 0.25, 0.9e6, 2}}, truth.mass_scale);
}

/// Per m² of floor: desks, shelves, inner partitions.
std::vector<Layer> furniture(const Truth& truth) {
  return with_mass({{0.03, 0.16, 0.9e6, 2}}, truth.mass_scale);
}

double storey_facade_m2(const Drawings& drawings, std::size_t side) {
  return drawings.facade_length_m(side) * drawings.storey_height_m;
}

double partition_m2(const Drawings& drawings, std::size_t side) {
  const double clear_height_m = drawings.storey_height_m - 0.6;
  if (side == special) {  // two blocks of rooms, walls in proportion to area
    return kSpecialWall_m * std::sqrt(drawings.zone_m2(special) / kSpecialWallFor_m2) *
           clear_height_m;
  }
  return (drawings.facade_length_m(side) - 2.0 * drawings.perimeter_depth_m) * clear_height_m;
}

double outdoor_convection_W_m2K(double wind_m_s) { return 5.6 + 3.9 * kTerrainFactor * wind_m_s; }

/// Wall-averaged pressure coefficient of a mid-rise block.
double wind_pressure_coefficient(double wind_from_deg, double facade_azimuth) {
  const double angle = (wind_from_deg - facade_azimuth) * std::numbers::pi / 180.0;
  const double facing = std::cos(angle);
  return facing > 0.0 ? -0.35 + 0.95 * facing : -0.35 + 0.10 * facing;
}

/// Leakage area is defined at 4 Pa with discharge coefficient 1; cracks follow a power law of 0.65.
double through_cracks_kg_s(double area_m2, double inward_Pa, double density) {
  if (inward_Pa <= 0.0) return 0.0;
  const double flow_at_4_Pa_m3_s = area_m2 * std::sqrt(2.0 * 4.0 / density);
  return density * flow_at_4_Pa_m3_s * std::pow(inward_Pa / 4.0, 0.65);
}

}  // namespace

Envelope::Envelope(const Truth& truth, AirState initial)
    : truth_(truth), effects_(truth.drawings.zones()) {
  zones_.reserve(truth.drawings.zones());
  for (std::size_t zone = 0; zone < truth.drawings.zones(); ++zone) build_zone(zone, initial);
  join_neighbours();
}

void Envelope::build_zone(std::size_t zone, AirState initial) {
  const Drawings& drawings = truth_.drawings;
  const std::size_t storey = zone / kZonesPerStorey;
  const std::size_t side = zone % kZonesPerStorey;
  const double area_m2 = drawings.zone_m2(side);
  const double start_C = initial.temperature_C;
  const bool top = storey + 1 == drawings.storeys_simulated();
  const double skylight_m2 = top && side == core ? drawings.skylight_m2() : 0.0;
  std::vector<ZoneSurface> surfaces;
  if (storey == 0) {
    exposed_.push_back({zone, kFloor, Face::ground, 0, area_m2});
    surfaces.push_back({Wall(slab_on_ground(truth_), start_C), area_m2, 0.0});
  } else {
    surfaces.push_back({Wall(half_slab(truth_), start_C), area_m2, 0.0});
  }
  if (top) {
    exposed_.push_back({zone, kCeiling, Face::roof, 0, area_m2 - skylight_m2});
    surfaces.push_back({Wall(flat_roof(truth_), start_C), area_m2 - skylight_m2, 0.0});
  } else {
    surfaces.push_back({Wall(half_slab(truth_), start_C), area_m2, 0.0});
  }
  for (const std::size_t other : kAroundCore) {
    if (side != core && other != side) continue;
    surfaces.push_back({Wall(half_partition(truth_), start_C), partition_m2(drawings, other), 0.0});
  }
  surfaces.push_back({Wall(furniture(truth_), start_C), area_m2, 0.0});
  if (side <= west) add_facade(zone, side, surfaces, start_C);
  if (skylight_m2 > 0.0) {
    exposed_.push_back({zone, surfaces.size(), Face::skylight, 0, skylight_m2});
    surfaces.push_back({Wall::massless(start_C), skylight_m2, 0.0});
  }
  // The floor takes half of the gains, the other surfaces share the rest by area.
  double others_m2 = 0.0;
  for (std::size_t i = 1; i < surfaces.size(); ++i) others_m2 += surfaces[i].area_m2;
  for (ZoneSurface& surface : surfaces) surface.solar_share = 0.5 * surface.area_m2 / others_m2;
  surfaces[kFloor].solar_share = 0.5;
  zones_.emplace_back(std::move(surfaces), area_m2 * drawings.storey_height_m * 0.85, initial);
}

void Envelope::add_facade(std::size_t zone, std::size_t side, std::vector<ZoneSurface>& surfaces,
                          double start_C) {
  const double facade_m2 = storey_facade_m2(truth_.drawings, side);
  const double window_share = truth_.drawings.window_share;
  exposed_.push_back({zone, surfaces.size(), Face::wall, side, (1.0 - window_share) * facade_m2});
  surfaces.push_back({Wall(exterior_wall(truth_), start_C), (1.0 - window_share) * facade_m2, 0.0});
  exposed_.push_back({zone, surfaces.size(), Face::window, side, window_share * facade_m2});
  surfaces.push_back({Wall::massless(start_C), window_share * facade_m2, 0.0});
}

void Envelope::join_neighbours() {
  constexpr double slab_middle_W_m2K = 20.0;      // carpet and ceiling void in series
  constexpr double partition_middle_W_m2K = 3.0;  // stud cavity
  const std::size_t storeys = truth_.drawings.storeys_simulated();
  for (std::size_t storey = 0; storey < storeys; ++storey) {
    const std::size_t first = storey * kZonesPerStorey;
    for (std::size_t i = 0; i < kAroundCore.size(); ++i) {
      joints_.push_back({first + kAroundCore[i], kPartition, first + core, kPartition + i,
                         partition_middle_W_m2K});
    }
    if (storey + 1 == storeys) continue;
    for (std::size_t side = south; side <= special; ++side) {
      joints_.push_back(
          {first + side, kCeiling, first + side + kZonesPerStorey, kFloor, slab_middle_W_m2K});
    }
  }
}

void Envelope::join_halves() {
  for (const Joint& joint : joints_) {
    const double flux_W_m2 =
        joint.conductance_W_m2K *
        (zones_[joint.second_zone].surface(joint.second_surface).wall.outer_node_C() -
         zones_[joint.first_zone].surface(joint.first_surface).wall.outer_node_C());
    zones_[joint.first_zone].set_outer_side(joint.first_surface, {0.0, 0.0, flux_W_m2});
    zones_[joint.second_zone].set_outer_side(joint.second_surface, {0.0, 0.0, -flux_W_m2});
  }
}

OuterSide Envelope::expose_window(const Exposed& face, const OuterSide& film, const Irradiance& sun,
                                  double sun_factor) {
  constexpr double absorbed_share = 0.2;         // of SHGC: absorbed and passed on by panes, blinds
  constexpr double diffuse_angle_factor = 0.84;  // hemispherical mean
  const double pane_m2K_W = 1.0 / truth_.window_u_W_m2K - 1.0 / 7.7 - 1.0 / 25.0;
  const double through_W_m2 = sun.beam_W_m2 * glazing_angle_factor(sun.cosine_incidence) +
                              diffuse_angle_factor * sun.diffuse_W_m2;
  // Blinds come down in the sun; some are never raised.
  const double drawn = face.face == Face::skylight ? 0.0 : sun.total_W_m2() > 230.0 ? 0.70 : 0.30;
  const double gain_W_m2 = sun_factor * truth_.window_shgc *
                           (1.0 - truth_.drawings.window_frame_share) * through_W_m2 *
                           (1.0 - drawn * (1.0 - truth_.blind_transmittance));
  effects_[face.zone].transmitted_sun_W += (1.0 - absorbed_share) * gain_W_m2 * face.area_m2;
  OuterSide outer = film;
  outer.conductance_W_m2K = 1.0 / (pane_m2K_W + 1.0 / film.conductance_W_m2K);
  // Of what the pane absorbs, only the part that flows inward counts in the SHGC.
  outer.source_W_m2 = absorbed_share * gain_W_m2 * (kIndoorFilm_W_m2K + outer.conductance_W_m2K) /
                      kIndoorFilm_W_m2K;
  return outer;
}

void Envelope::expose_faces(const Outdoors& outdoors, const std::array<Irradiance, 5>& irradiance,
                            const EnvelopeOperation& operation) {
  const Drawings& drawings = truth_.drawings;
  const double convection = outdoor_convection_W_m2K(outdoors.wind_speed_m_s);
  const double air_C = outdoors.air.temperature_C;
  // A wall sees half sky, half surroundings at air temperature; a roof sees only sky.
  const auto film = [&](double sky_view) {
    return OuterSide{
        convection + kOutdoorRadiation_W_m2K,
        (convection * air_C + kOutdoorRadiation_W_m2K * (sky_view * outdoors.sky_temperature_C +
                                                         (1.0 - sky_view) * air_C)) /
            (convection + kOutdoorRadiation_W_m2K),
        0.0};
  };
  for (EnvelopeEffect& effect : effects_) effect = {};
  for (const Exposed& face : exposed_) {
    const bool faces_sky = face.face == Face::roof || face.face == Face::skylight;
    OuterSide outer = film(faces_sky ? 1.0 : 0.4);
    switch (face.face) {
      case Face::ground:
        outer = {2.0, truth_.ground_C + operation.ground_shift_K, 0.0};
        break;
      case Face::roof:
        outer.source_W_m2 = drawings.roof_absorptance * irradiance[4].total_W_m2();
        break;
      case Face::wall:
        outer.source_W_m2 = drawings.wall_absorptance * irradiance[face.side].total_W_m2();
        break;
      case Face::window:
        outer = expose_window(face, outer, irradiance[face.side], operation.sun_factor[face.side]);
        break;
      case Face::skylight:
        outer = expose_window(face, outer, irradiance[4], operation.skylight_factor);
        break;
    }
    zones_[face.zone].set_outer_side(face.surface, outer);
  }
}

double Envelope::exposed_heat_W() const {
  double sum_W = 0.0;
  for (const Exposed& face : exposed_) {
    sum_W += face.area_m2 * zones_[face.zone].surface(face.surface).wall.outer_flux_W_m2();
  }
  return sum_W;
}

/// Exterior area whose cracks open into the zone of a facade.
double Envelope::leaking_m2(std::size_t side, bool top) const {
  const Drawings& drawings = truth_.drawings;
  double roof_m2 = top ? drawings.zone_m2(side) : 0.0;
  if (drawings.hall) roof_m2 /= drawings.perimeter_floor_share();  // includes the core's part
  return storey_facade_m2(drawings, side) + roof_m2;
}

double Envelope::infiltration_kg_s(std::size_t zone, const Outdoors& outdoors, double pressurised,
                                   const EnvelopeOperation& operation) const {
  const Drawings& drawings = truth_.drawings;
  const std::size_t side = zone % kZonesPerStorey;
  if (side > west) return 0.0;  // the air reaches the core only through the perimeter
  const std::size_t storey = zone / kZonesPerStorey;
  const bool top = storey + 1 == drawings.storeys_simulated();
  const auto storeys = static_cast<double>(drawings.storeys);
  const double level = storey == 0 ? 0.5 : top ? storeys - 0.5 : 0.5 * storeys;
  const double height_m = level * drawings.storey_height_m;
  const double neutral_m = 0.5 * storeys * drawings.storey_height_m;
  const double density = density_kg_m3(outdoors.air.temperature_C, outdoors.pressure_Pa);
  const double local_wind = kTerrainFactor * outdoors.wind_speed_m_s;
  const double wind_Pa =
      0.5 * density * local_wind * local_wind *
      (wind_pressure_coefficient(outdoors.wind_from_deg, kFacadeAzimuth_deg[side]) + 0.15);
  const double warmer_inside_K = zones_[zone].air().temperature_C - outdoors.air.temperature_C;
  const double stack_Pa = density * 9.81 * (neutral_m - height_m) * warmer_inside_K /
                          (outdoors.air.temperature_C + 273.15);
  const double inward_Pa = wind_Pa + stack_Pa - (drawings.pressurised_Pa * pressurised - 0.5);
  const double area_m2 = truth_.leakage_cm2_m2 * 1e-4 * leaking_m2(side, top);
  double flow_kg_s = 0.0;
  if (drawings.hall) {
    // Half of the cracks lie a quarter of the height below the middle, half above.
    const double within_Pa = density * 9.81 * 0.25 * drawings.storey_height_m * warmer_inside_K /
                             (outdoors.air.temperature_C + 273.15);
    flow_kg_s = through_cracks_kg_s(0.5 * area_m2, inward_Pa + within_Pa, density) +
                through_cracks_kg_s(0.5 * area_m2, inward_Pa - within_Pa, density);
  } else {
    flow_kg_s = through_cracks_kg_s(area_m2, inward_Pa, density);
  }
  if (storey == 0 && inward_Pa > 0.0) {
    flow_kg_s += kDischarge * operation.opening_m2[side] * std::sqrt(2.0 * density * inward_Pa);
  }
  const double perimeter_m2 = (drawings.storey_m2() - drawings.core_and_special_m2()) *
                              static_cast<double>(drawings.storeys);
  flow_kg_s += density * operation.extraction_m3_s * drawings.zone_m2(side) / perimeter_m2;
  return flow_kg_s + shaft_kg_s(storey, warmer_inside_K, density, outdoors, operation.shaft_m2) +
         open_window_kg_s(zone, warmer_inside_K, density, local_wind, operation.window_opening_m2);
}

/// A shaft open at both ends: in winter air comes in at the bottom, in summer at the top.
double Envelope::shaft_kg_s(std::size_t storey, double warmer_inside_K, double density,
                            const Outdoors& outdoors, double shaft_m2) const {
  const Drawings& drawings = truth_.drawings;
  const std::size_t inlet = warmer_inside_K > 0.0 ? 0 : drawings.storeys_simulated() - 1;
  if (shaft_m2 <= 0.0 || storey != inlet) return 0.0;
  const double half_height_m =
      0.5 * static_cast<double>(drawings.storeys) * drawings.storey_height_m;
  const double drawing_Pa = density * 9.81 * half_height_m * std::abs(warmer_inside_K) /
                            (outdoors.air.temperature_C + 273.15);
  constexpr double sides = 4.0;  // each takes its share of the inlet
  return kDischarge * shaft_m2 / sides * std::sqrt(2.0 * density * drawing_Pa);
}

/// Air through windows on one side of a room. @see de Gids, Phaff (1982), Air Infiltration
/// Review 4.
double Envelope::open_window_kg_s(std::size_t zone, double warmer_inside_K, double density,
                                  double wind_m_s, double all_windows_m2) const {
  if (all_windows_m2 <= 0.0) return 0.0;
  const Drawings& drawings = truth_.drawings;
  const double share = drawings.facade_length_m(zone % kZonesPerStorey) /
                       (2.0 * (drawings.length_m + drawings.width_m)) /
                       static_cast<double>(drawings.storeys_simulated());
  constexpr double window_height_m = 1.2;
  const double speed_m_s = std::sqrt(0.001 * wind_m_s * wind_m_s +
                                     0.0035 * window_height_m * std::abs(warmer_inside_K) + 0.01);
  return 0.5 * density * share * all_windows_m2 * speed_m_s;
}

const std::vector<EnvelopeEffect>& Envelope::expose(const Outdoors& outdoors,
                                                    const std::vector<double>& pressurised,
                                                    const EnvelopeOperation& operation) {
  std::array<Irradiance, 5> irradiance{};
  for (std::size_t side = 0; side < 4; ++side) {
    irradiance[side] = irradiance_on({kFacadeAzimuth_deg[side], 90.0}, outdoors.sun, outdoors.sky,
                                     kGroundReflectance);
  }
  irradiance[4] = irradiance_on({180.0, 0.0}, outdoors.sun, outdoors.sky, kGroundReflectance);
  expose_faces(outdoors, irradiance, operation);
  join_halves();
  for (std::size_t zone = 0; zone < zones_.size(); ++zone) {
    effects_[zone].infiltration_kg_s =
        infiltration_kg_s(zone, outdoors, pressurised[zone / kZonesPerStorey], operation);
  }
  return effects_;
}

}  // namespace recald::simulators
