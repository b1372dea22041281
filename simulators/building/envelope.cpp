#include "simulators/building/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace recald::simulators {
namespace {

using namespace drawings;

constexpr double kOutdoorRadiation_W_m2K = 5.0;  ///< Linearised long-wave exchange outdoors.
constexpr double kGroundReflectance = 0.2;
constexpr double kIndoorFilm_W_m2K = 8.1;  ///< As the zones have it: convection plus radiation.
constexpr double kTerrainFactor = 0.55;    ///< Wind at the building against the open station.

/// Every zone's first two surfaces are its floor and its ceiling.
constexpr std::size_t kFloor = 0;
constexpr std::size_t kCeiling = 1;
/// Then comes the first partition: offices and equipment rooms have one, to the
/// laboratory; the laboratory has five, to them, in `kAroundLaboratory` order.
constexpr std::size_t kPartition = 2;
constexpr std::array<std::size_t, 5> kAroundLaboratory{south, north, east, west, equipment};

std::vector<Layer> exterior_wall(double u_W_m2K) {
  std::vector<Layer> layers{{0.10, 0.80, 1.50e6, 2},    // brick
                            {0.05, 0.035, 4.0e4, 2},    // insulation
                            {0.15, 0.90, 1.60e6, 3},    // concrete block
                            {0.015, 0.20, 0.80e6, 1}};  // gypsum board
  set_u_value(layers, 1, u_W_m2K);
  return layers;
}

std::vector<Layer> flat_roof(double u_W_m2K) {
  std::vector<Layer> layers{{0.02, 0.20, 1.6e6, 1},   // membrane and ballast
                            {0.10, 0.035, 4.0e4, 2},  // insulation
                            {0.18, 1.60, 2.1e6, 4}};  // concrete
  set_u_value(layers, 1, u_W_m2K);
  return layers;
}

std::vector<Layer> slab_on_ground(double u_W_m2K) {
  std::vector<Layer> layers{{1.00, 1.30, 1.8e6, 4},   // soil that takes part within the year
                            {0.05, 0.035, 4.0e4, 1},  // insulation
                            {0.18, 1.60, 2.1e6, 4}};
  set_u_value(layers, 1, u_W_m2K);
  return layers;
}

const std::vector<Layer>& half_slab() {
  static const std::vector<Layer> layers{{0.10, 1.60, 2.1e6, 3}};
  return layers;
}

const std::vector<Layer>& half_partition() {
  static const std::vector<Layer> layers{{0.025, 0.25, 0.9e6, 2}};
  return layers;
}

/// Seen per m² of floor: desks, shelves, inner partitions.
const std::vector<Layer>& furniture() {
  static const std::vector<Layer> layers{{0.03, 0.16, 0.9e6, 2}};
  return layers;
}

double storey_facade_m2(std::size_t side) { return facade_length_m[side] * storey_height_m; }

double partition_m2(std::size_t side) {
  constexpr double clear_height_m = storey_height_m - 0.6;
  if (side == equipment) return 60.0 * clear_height_m;  // two blocks of rooms
  const double core_length_m =
      (side == south || side == north ? length_m : width_m) - 2.0 * perimeter_depth_m;
  return core_length_m * clear_height_m;
}

double outdoor_convection_W_m2K(double wind_m_s) { return 5.6 + 3.9 * kTerrainFactor * wind_m_s; }

/// Wall-averaged pressure coefficient of a mid-rise block.
double wind_pressure_coefficient(double wind_from_deg, double facade_azimuth) {
  const double angle = (wind_from_deg - facade_azimuth) * std::numbers::pi / 180.0;
  const double facing = std::cos(angle);
  return facing > 0.0 ? -0.35 + 0.95 * facing : -0.35 + 0.10 * facing;
}

}  // namespace

Envelope::Envelope(const Truth& truth, AirState initial) : truth_(truth) {
  zones_.reserve(drawings::zones);
  for (std::size_t zone = 0; zone < drawings::zones; ++zone) build_zone(truth, zone, initial);
  join_neighbours();
}

void Envelope::build_zone(const Truth& truth, std::size_t zone, AirState initial) {
  const std::size_t storey = zone / zones_per_storey;
  const std::size_t side = zone % zones_per_storey;
  const double area_m2 = zone_area_m2[side];
  const double start_C = initial.temperature_C;
  std::vector<ZoneSurface> surfaces;
  if (storey == 0) {
    exposed_.push_back({zone, kFloor, Face::ground, 0, area_m2});
    surfaces.push_back({Wall(slab_on_ground(truth.ground_u_W_m2K), start_C), area_m2, 0.0});
  } else {
    surfaces.push_back({Wall(half_slab(), start_C), area_m2, 0.0});
  }
  if (storey + 1 == storeys) {
    exposed_.push_back({zone, kCeiling, Face::roof, 0, area_m2});
    surfaces.push_back({Wall(flat_roof(truth.roof_u_W_m2K), start_C), area_m2, 0.0});
  } else {
    surfaces.push_back({Wall(half_slab(), start_C), area_m2, 0.0});
  }
  for (const std::size_t other : kAroundLaboratory) {
    if (side != laboratory && other != side) continue;
    surfaces.push_back({Wall(half_partition(), start_C), partition_m2(other), 0.0});
  }
  surfaces.push_back({Wall(furniture(), start_C), area_m2, 0.0});
  if (side <= west) {
    const double facade_m2 = storey_facade_m2(side);
    exposed_.push_back({zone, surfaces.size(), Face::wall, side, (1.0 - window_share) * facade_m2});
    surfaces.push_back(
        {Wall(exterior_wall(truth.wall_u_W_m2K), start_C), (1.0 - window_share) * facade_m2, 0.0});
    exposed_.push_back({zone, surfaces.size(), Face::window, side, window_share * facade_m2});
    surfaces.push_back({Wall::massless(start_C), window_share * facade_m2, 0.0});
  }
  // The floor takes half of what comes in, the rest spreads by area.
  double others_m2 = 0.0;
  for (std::size_t i = 1; i < surfaces.size(); ++i) others_m2 += surfaces[i].area_m2;
  for (ZoneSurface& surface : surfaces) surface.solar_share = 0.5 * surface.area_m2 / others_m2;
  surfaces[kFloor].solar_share = 0.5;
  zones_.emplace_back(std::move(surfaces), area_m2 * storey_height_m * 0.85, initial);
}

void Envelope::join_neighbours() {
  constexpr double slab_middle_W_m2K = 20.0;      // carpet and ceiling void in series
  constexpr double partition_middle_W_m2K = 3.0;  // stud cavity
  for (std::size_t storey = 0; storey < storeys; ++storey) {
    const std::size_t first = storey * zones_per_storey;
    for (std::size_t i = 0; i < kAroundLaboratory.size(); ++i) {
      joints_.push_back({first + kAroundLaboratory[i], kPartition, first + laboratory,
                         kPartition + i, partition_middle_W_m2K});
    }
    if (storey + 1 == storeys) continue;
    for (std::size_t side = south; side <= equipment; ++side) {
      joints_.push_back(
          {first + side, kCeiling, first + side + zones_per_storey, kFloor, slab_middle_W_m2K});
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

OuterSide Envelope::expose_window(const Exposed& face, const OuterSide& film,
                                  const Irradiance& sun) {
  constexpr double absorbed_share = 0.2;         // of SHGC: heat that panes and blinds pass on
  constexpr double diffuse_angle_factor = 0.84;  // hemispherical mean
  const double pane_m2K_W = 1.0 / truth_.window_u_W_m2K - 1.0 / 7.7 - 1.0 / 25.0;
  const double through_W_m2 = sun.beam_W_m2 * glazing_angle_factor(sun.cosine_incidence) +
                              diffuse_angle_factor * sun.diffuse_W_m2;
  // Blinds come down in the sun; some are never raised.
  const double drawn = sun.total_W_m2() > 230.0 ? 0.70 : 0.30;
  const double gain_W_m2 = truth_.window_shgc * (1.0 - window_frame_share) * through_W_m2 *
                           (1.0 - drawn * (1.0 - truth_.blind_transmittance));
  effects_[face.zone].transmitted_sun_W += (1.0 - absorbed_share) * gain_W_m2 * face.area_m2;
  OuterSide outer = film;
  outer.conductance_W_m2K = 1.0 / (pane_m2K_W + 1.0 / film.conductance_W_m2K);
  // Of what the pane absorbs only the part that flows inward counts in the SHGC.
  outer.source_W_m2 = absorbed_share * gain_W_m2 * (kIndoorFilm_W_m2K + outer.conductance_W_m2K) /
                      kIndoorFilm_W_m2K;
  return outer;
}

void Envelope::expose_faces(const Outdoors& outdoors, const std::array<Irradiance, 5>& irradiance) {
  const double convection = outdoor_convection_W_m2K(outdoors.wind_speed_m_s);
  const double air_C = outdoors.air.temperature_C;
  // A wall sees half sky, half surroundings at air temperature; a roof sees the sky.
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
    OuterSide outer = film(face.face == Face::roof ? 1.0 : 0.4);
    switch (face.face) {
      case Face::ground:
        outer = {2.0, truth_.ground_C, 0.0};
        break;
      case Face::roof:
        outer.source_W_m2 = roof_absorptance * irradiance[4].total_W_m2();
        break;
      case Face::wall:
        outer.source_W_m2 = wall_absorptance * irradiance[face.side].total_W_m2();
        break;
      case Face::window:
        outer = expose_window(face, outer, irradiance[face.side]);
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

double Envelope::infiltration_kg_s(std::size_t zone, const Outdoors& outdoors,
                                   bool pressurised) const {
  const std::size_t side = zone % zones_per_storey;
  if (side > west) return 0.0;  // reaches the core only through the offices
  const std::size_t storey = zone / zones_per_storey;
  const double height_m = (static_cast<double>(storey) + 0.5) * storey_height_m;
  const double neutral_m = 0.5 * storeys * storey_height_m;
  const double density = density_kg_m3(outdoors.air.temperature_C, outdoors.pressure_Pa);
  const double local_wind = kTerrainFactor * outdoors.wind_speed_m_s;
  const double wind_Pa =
      0.5 * density * local_wind * local_wind *
      (wind_pressure_coefficient(outdoors.wind_from_deg, facade_azimuth_deg[side]) + 0.15);
  const double warmer_inside_K = zones_[zone].air().temperature_C - outdoors.air.temperature_C;
  const double stack_Pa = density * 9.81 * (neutral_m - height_m) * warmer_inside_K /
                          (outdoors.air.temperature_C + 273.15);
  const double inward_Pa = wind_Pa + stack_Pa - (pressurised ? 2.5 : -0.5);
  if (inward_Pa <= 0.0) return 0.0;
  // Leakage area is defined at 4 Pa with discharge coefficient 1; cracks follow a power of 0.65.
  const double leaking_m2 =
      storey_facade_m2(side) + (storey + 1 == storeys ? zone_area_m2[side] : 0.0);
  const double area_m2 = truth_.leakage_cm2_m2 * 1e-4 * leaking_m2;
  const double flow_at_4_Pa_m3_s = area_m2 * std::sqrt(2.0 * 4.0 / density);
  return density * flow_at_4_Pa_m3_s * std::pow(inward_Pa / 4.0, 0.65);
}

const std::array<EnvelopeEffect, drawings::zones>& Envelope::expose(
    const Outdoors& outdoors, const std::array<bool, storeys>& pressurised) {
  std::array<Irradiance, 5> irradiance{};
  for (std::size_t side = 0; side < 4; ++side) {
    irradiance[side] = irradiance_on({facade_azimuth_deg[side], 90.0}, outdoors.sun, outdoors.sky,
                                     kGroundReflectance);
  }
  irradiance[4] = irradiance_on({180.0, 0.0}, outdoors.sun, outdoors.sky, kGroundReflectance);
  expose_faces(outdoors, irradiance);
  join_halves();
  for (std::size_t zone = 0; zone < drawings::zones; ++zone) {
    effects_[zone].infiltration_kg_s =
        infiltration_kg_s(zone, outdoors, pressurised[zone / zones_per_storey]);
  }
  return effects_;
}

}  // namespace recald::simulators
