#include "simulators/building/zone.hpp"

#include <cmath>

namespace recald::simulators {
namespace {

constexpr double kConvection_W_m2K = 3.0;  ///< Mean of walls, floors and ceilings indoors.
constexpr double kRadiation_W_m2K = 5.1;   ///< 4 eps sigma T³ at room temperature.
constexpr double kAirDensity_kg_m3 = 1.17;
constexpr double kFurnitureFactor = 6.0;
constexpr double kMoistureFactor = 12.0;  ///< Paper, boards and furniture buffer moisture.

}  // namespace

Zone::Zone(std::vector<ZoneSurface> surfaces, double air_volume_m3, AirState initial)
    : surfaces_(std::move(surfaces)),
      outer_(surfaces_.size()),
      room_side_(surfaces_.size()),
      air_capacity_J_K_(kFurnitureFactor * air_volume_m3 * kAirDensity_kg_m3 * kDryAirHeat_J_kgK),
      moisture_capacity_kg_(kMoistureFactor * air_volume_m3 * kAirDensity_kg_m3),
      air_(initial),
      radiant_C_(initial.temperature_C) {}

Zone::Solution Zone::solve(const ZoneLoads& loads, double step_s) {
  constexpr double h_c = kConvection_W_m2K;
  constexpr double h_r = kRadiation_W_m2K;
  const double supply_W_K = loads.supply_kg_s * heat_capacity_J_kgK(loads.supply);
  const double infiltration_W_K = loads.infiltration_kg_s * heat_capacity_J_kgK(loads.outdoor);
  double air_air = air_capacity_J_K_ / step_s + supply_W_K + infiltration_W_K;
  double air_source = air_capacity_J_K_ / step_s * air_.temperature_C + loads.convective_W +
                      loads.exchange_W + supply_W_K * loads.supply.temperature_C +
                      infiltration_W_K * loads.outdoor.temperature_C;
  double air_radiant = 0.0;
  double radiant_radiant = 0.0;
  double radiant_source = 0.0;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    ZoneSurface& surface = surfaces_[i];
    RoomSide& side = room_side_[i];
    side = surface.wall.eliminate(outer_[i], step_s);
    side.r_W_m2 += surface.solar_share * loads.radiant_W / surface.area_m2;
    side.d_W_m2K += h_c + h_r;
    const double share = surface.area_m2 / side.d_W_m2K;
    air_air += surface.area_m2 * h_c - share * h_c * h_c;
    air_radiant += share * h_c * h_r;
    radiant_radiant += surface.area_m2 * h_r - share * h_r * h_r;
    air_source += share * h_c * side.r_W_m2;
    radiant_source += share * h_r * side.r_W_m2;
  }
  const double determinant = air_air * radiant_radiant - air_radiant * air_radiant;
  return {(air_source * radiant_radiant + air_radiant * radiant_source) / determinant,
          (air_air * radiant_source + air_radiant * air_source) / determinant};
}

ZoneHeat Zone::advance(const ZoneLoads& loads, double step_s) {
  const auto [air_C, radiant_C] = solve(loads, step_s);
  ZoneHeat heat{};
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const RoomSide& side = room_side_[i];
    surfaces_[i].wall.substitute(
        (side.r_W_m2 + kConvection_W_m2K * air_C + kRadiation_W_m2K * radiant_C) / side.d_W_m2K);
    heat.constructions_J += surfaces_[i].area_m2 * surfaces_[i].wall.outer_flux_W_m2() * step_s;
  }
  heat.gains_J = (loads.convective_W + loads.radiant_W) * step_s;
  heat.supply_J = loads.supply_kg_s * heat_capacity_J_kgK(loads.supply) *
                  (loads.supply.temperature_C - air_C) * step_s;
  heat.infiltration_J = loads.infiltration_kg_s * heat_capacity_J_kgK(loads.outdoor) *
                        (loads.outdoor.temperature_C - air_C) * step_s;
  heat.exchange_J = loads.exchange_W * step_s;
  advance_moisture(loads, step_s);
  air_.temperature_C = air_C;
  radiant_C_ = radiant_C;
  return heat;
}

void Zone::advance_moisture(const ZoneLoads& loads, double step_s) {
  const double held_kg_s = moisture_capacity_kg_ / step_s;
  const double in_kg_s = loads.moisture_kg_s + loads.exchange_moisture_kg_s +
                         loads.supply_kg_s * loads.supply.humidity_kg_kg +
                         loads.infiltration_kg_s * loads.outdoor.humidity_kg_kg;
  air_.humidity_kg_kg = (held_kg_s * air_.humidity_kg_kg + in_kg_s) /
                        (held_kg_s + loads.supply_kg_s + loads.infiltration_kg_s);
}

double Zone::stored_J() const {
  double sum_J = air_capacity_J_K_ * air_.temperature_C;
  for (const ZoneSurface& surface : surfaces_) {
    sum_J += surface.area_m2 * surface.wall.stored_J_m2();
  }
  return sum_J;
}

}  // namespace recald::simulators
