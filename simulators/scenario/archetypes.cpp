#include "simulators/scenario/archetypes.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "simulators/climate/normals.hpp"

namespace recald::simulators {
namespace {

constexpr double kAirHeat_kJ_m3K = 1.15 * 1.006;
constexpr double kIndoorSummer_C = 24.0;
constexpr double kIndoorWinter_C = 21.0;

double rounded(double value, double step) { return std::round(value / step) * step; }

void use_as_office(Drawings& drawings) {
  drawings.perimeter_rooms = {1.1, 8.4, 8.8, 0.05, 0.05, 9.0, 10.0, 0.28, 0.62, 0.0, 0.03, false};
  drawings.core_rooms = {1.0, 8.6, 8.8, 0.04, 0.05, 9.0, 11.0, 0.26, 0.62, 0.0, 0.03, false};
  drawings.special_rooms = {0.0, 0.0, 0.0, 0.0, 0.0, 8.0, 90.0, 0.62, 0.0, 0.08, 0.03, false};
  drawings.special_share_of_core = 0.06;  // closets with servers and copiers
  drawings.occupancy_person_m2 = 0.05;
  drawings.core_runs_always = false;
  drawings.core_min_share = 0.30;
  drawings.perimeter_min_share = 0.30;
  drawings.occupied_from_h = 7.0;
  drawings.occupied_to_h = 19.0;
  drawings.night_cooling_C = 29.0;
  drawings.presence_workday = {0,    0,    0,    0,    0,    0.01, 0.05, 0.22,
                               0.55, 0.77, 0.79, 0.78, 0.61, 0.70, 0.79, 0.78,
                               0.66, 0.36, 0.14, 0.05, 0.03, 0.01, 0,    0};
  drawings.presence_weekend = {0,    0,    0,    0,    0,    0, 0, 0, 0, 0.01, 0.01, 0.02,
                               0.02, 0.02, 0.02, 0.01, 0.01, 0, 0, 0, 0, 0,    0,    0};
}

void use_as_school(Drawings& drawings) {
  drawings.perimeter_rooms = {1.25, 7.8, 7.1, 0.02, 0.03, 9.5, 5.0, 0.20, 0.55, 0.0, 0.03, false};
  drawings.core_rooms = {1.0, 7.9, 7.2, 0.02, 0.05, 8.5, 4.0, 0.25, 0.40, 0.0, 0.03, false};
  drawings.special_rooms = {0.0, 0.0, 0.0, 0.0, 0.0, 9.0, 35.0, 0.22, 0.0, 0.38, 0.05, true};
  drawings.special_share_of_core = 0.2;  // kitchen and computer rooms
  drawings.occupancy_person_m2 = 0.14;
  drawings.sensible_W_person = 65.0;
  drawings.latent_W_person = 45.0;
  drawings.core_runs_always = false;
  drawings.core_min_share = 0.40;
  drawings.perimeter_min_share = 0.40;
  drawings.occupied_from_h = 7.0;
  drawings.occupied_to_h = 17.0;
  drawings.presence_workday = {0,    0,    0,    0,    0,    0,    0.12, 0.57,
                               0.79, 0.80, 0.80, 0.79, 0.63, 0.72, 0.72, 0.30,
                               0.08, 0.03, 0.02, 0.02, 0.01, 0,    0,    0};
  drawings.presence_weekend = {0,    0,    0,    0,    0, 0, 0, 0, 0, 0, 0.01, 0.01,
                               0.01, 0.01, 0.01, 0.01, 0, 0, 0, 0, 0, 0, 0,    0};
}

struct Constructions {
  double wall_u_W_m2K, roof_u_W_m2K, window_u_W_m2K, ground_u_W_m2K, shgc;
  std::optional<double> economiser_limit_C;
};

/// What codes of the 2000s ask for; economisers where ASHRAE 90.1 wants them.
Constructions constructions_for(ClimateKind climate) {
  switch (climate) {
    case ClimateKind::hot_humid:
      return {0.50, 0.30, 2.6, 0.40, 0.30, std::nullopt};
    case ClimateKind::hot_dry:
      return {0.50, 0.28, 2.6, 0.40, 0.28, 24.0};
    case ClimateKind::mixed:
      return {0.42, 0.26, 2.2, 0.35, 0.38, 18.0};
    case ClimateKind::cold:
      return {0.34, 0.20, 1.9, 0.30, 0.42, 21.0};
    case ClimateKind::marine:
      return {0.40, 0.24, 2.1, 0.35, 0.40, 24.0};
  }
  return {};
}

void place_in(Drawings& drawings, ClimateKind climate) {
  const City& city = comparable_city(climate);
  const double mean_C = annual_mean(normals_of(climate).dry_bulb_C);
  const Constructions built = constructions_for(climate);
  drawings.climate = climate;
  drawings.place = city.place;
  drawings.time_zone = city.time_zone;
  drawings.wall_u_W_m2K = built.wall_u_W_m2K;
  drawings.roof_u_W_m2K = built.roof_u_W_m2K;
  drawings.window_u_W_m2K = built.window_u_W_m2K;
  drawings.ground_u_W_m2K = built.ground_u_W_m2K;
  drawings.window_shgc = built.shgc;
  drawings.economiser_limit_C = built.economiser_limit_C;
  drawings.mains_C = rounded(std::clamp(mean_C, 8.0, 24.0), 0.5);
  drawings.ground_C = rounded(std::clamp(mean_C + 2.0, 9.0, 24.0), 0.5);
}

std::string_view services_in_words(const Drawings& drawings) {
  switch (drawings.heating) {
    case HeatingPlant::district_steam:
      return "steam from the district";
    case HeatingPlant::district_water:
      return "hot water from the district";
    case HeatingPlant::boiler:
      return "a gas boiler";
    case HeatingPlant::heat_pump:
      return "an air-source heat pump";
  }
  return "";
}

void describe(Drawings& drawings) {
  const std::string_view use = to_string(drawings.use);
  drawings.id = std::string(use);
  drawings.name = std::string(use);
  drawings.name.front() = static_cast<char>(std::toupper(drawings.name.front()));
  drawings.description = fmt::format(
      "{} building: {} storey{} of {} m by {} m, air handlers for the rooms along the facades and "
      "for the core (variable air volume, reheat), {}, {}, electricity from the utility.",
      drawings.name, drawings.storeys, drawings.storeys == 1 ? "" : "s", drawings.length_m,
      drawings.width_m,
      drawings.cooling == CoolingPlant::district ? "chilled water from the district"
                                                 : "an own chiller behind a chilled-water meter",
      services_in_words(drawings));
}

double outdoor_air_l_s_m2(const Drawings& drawings, bool perimeter) {
  switch (drawings.use) {
    case Use::laboratory:
      return perimeter ? 0.8 : 3.1;
    case Use::office:
      return perimeter ? 0.75 : 0.65;
    case Use::school:
      return perimeter ? 1.5 : 0.9;
  }
  return 0.0;
}

/// Peak sensible load of a zone by rule of thumb: people and machines, sun at its height, walls.
double peak_load_W(const Drawings& drawings, std::size_t side, double design_C) {
  constexpr std::array<double, 4> sun_W_m2{450.0, 180.0, 650.0, 700.0};
  const RoomUse& rooms = drawings.rooms(side);
  const double busy = rooms.plugs_standing_share + rooms.plugs_people_share +
                      rooms.plugs_working_share + (rooms.appliance_runs ? 0.15 : 0.0);
  const double gains_W_m2 = 0.9 * (rooms.lighting_W_m2 + busy * rooms.plugs_W_m2) +
                            drawings.sensible_W_person * drawings.occupancy_person_m2;
  double load_W = gains_W_m2 * drawings.zone_m2(side);
  if (side <= west) {
    const double facade_m2 = drawings.facade_length_m(side) * drawings.storey_height_m;
    const double window_m2 = drawings.window_share * facade_m2;
    load_W += window_m2 * drawings.window_shgc * (1.0 - drawings.window_frame_share) * 0.65 *
              sun_W_m2[side];
    load_W +=
        (window_m2 * drawings.window_u_W_m2K + (facade_m2 - window_m2) * drawings.wall_u_W_m2K) *
        (design_C - kIndoorSummer_C);
  }
  if (side == core && drawings.skylight_share > 0.0) {
    load_W += drawings.skylight_m2() * drawings.window_shgc * 700.0;
  }
  return load_W;
}

void size_flows(Drawings& drawings, double design_C) {
  constexpr double supply_difference_K = 11.0;
  constexpr double margin = 1.15;
  for (std::size_t side = south; side <= special; ++side) {
    const double flow_m3_s = margin * peak_load_W(drawings, side, design_C) /
                             (1000.0 * kAirHeat_kJ_m3K * supply_difference_K);
    drawings.zone_supply_m3_s[side] = std::max(0.05, rounded(flow_m3_s, 0.01));
  }
}

AirHandlerPlate air_handler_for(const Drawings& drawings, bool perimeter, double design_winter_C) {
  const double area_m2 = perimeter ? drawings.storey_m2() - drawings.core_and_special_m2()
                                   : drawings.core_and_special_m2();
  const double flow_m3_s =
      perimeter ? drawings.perimeter_supply_m3_s() : drawings.core_supply_m3_s();
  const double outdoor_m3_s =
      std::min(0.9 * flow_m3_s, outdoor_air_l_s_m2(drawings, perimeter) * area_m2 / 1000.0);
  const bool exhausts = drawings.use == Use::laboratory && !perimeter;
  // Humid outdoor air asks for more of the coil than returned air.
  const double moisture =
      drawings.climate == ClimateKind::hot_humid || drawings.climate == ClimateKind::mixed ? 46.0
                                                                                           : 28.0;
  return {.outdoor_m3_s = rounded(outdoor_m3_s, 0.01),
          .fan_kW = std::max(0.2, rounded((exhausts ? 2.1 : 1.7) * flow_m3_s, 0.1)),
          .fan_share_in_airstream = exhausts ? 0.60 : 0.75,
          .coil_kW = std::max(5.0, rounded(21.0 * flow_m3_s + moisture * outdoor_m3_s, 1.0)),
          .coil_bypass_factor = exhausts ? 0.07 : 0.10,
          .preheat_kW = std::max(
              5.0, rounded(1.5 * kAirHeat_kJ_m3K * outdoor_m3_s * (14.0 - design_winter_C), 1.0))};
}

double envelope_W_K(const Drawings& drawings) {
  const double facade_m2 = 2.0 * (drawings.length_m + drawings.width_m) *
                           static_cast<double>(drawings.storeys) * drawings.storey_height_m;
  const double window_m2 = drawings.window_share * facade_m2 + drawings.skylight_m2();
  return window_m2 * drawings.window_u_W_m2K + (facade_m2 - window_m2) * drawings.wall_u_W_m2K +
         drawings.storey_m2() * drawings.roof_u_W_m2K;
}

double connected_kW(const Drawings& drawings) {
  double rooms_kW = 0.0;
  for (std::size_t side = south; side <= special; ++side) {
    const RoomUse& rooms = drawings.rooms(side);
    rooms_kW += (rooms.lighting_W_m2 + rooms.plugs_W_m2) * drawings.zone_m2(side) / 1000.0;
  }
  const double storey_kW = rooms_kW + drawings.perimeter_air.fan_kW + drawings.core_air.fan_kW;
  double sum_kW =
      static_cast<double>(drawings.storeys) * storey_kW + drawings.pump_kW + drawings.exterior_kW;
  if (drawings.cooling == CoolingPlant::chiller) {
    sum_kW += drawings.chilled_water_design_kW / drawings.chiller_cop;
  }
  if (drawings.heating == HeatingPlant::heat_pump) sum_kW += 0.6 * drawings.heating_design_kW;
  return sum_kW;
}

}  // namespace

void size_services(Drawings& drawings) {
  const Normals& normals = normals_of(drawings.climate);
  const auto storeys = static_cast<double>(drawings.storeys);
  size_flows(drawings, normals.cooling_design_C);
  drawings.perimeter_air = air_handler_for(drawings, true, normals.heating_design_C);
  drawings.core_air = air_handler_for(drawings, false, normals.heating_design_C);
  const double coils_kW = storeys * (drawings.perimeter_air.coil_kW + drawings.core_air.coil_kW);
  drawings.chilled_water_design_kW = rounded(0.65 * coils_kW, 1.0);
  const double heat_W_K =
      envelope_W_K(drawings) + 1000.0 * kAirHeat_kJ_m3K * drawings.outdoor_air_m3_s();
  drawings.heating_design_kW =
      rounded(1.3 * heat_W_K * (kIndoorWinter_C - normals.heating_design_C) / 1000.0, 1.0);
  drawings.pump_kW = std::max(
      0.3,
      rounded(0.0085 * (drawings.chilled_water_design_kW + 0.5 * drawings.heating_design_kW), 0.1));
  drawings.exterior_kW = rounded(0.0007 * drawings.floor_area_m2(), 0.1);
  drawings.heating_standing_kW = rounded(0.008 * drawings.heating_design_kW, 0.1);
  drawings.chilled_water_standing_kW = rounded(0.0005 * drawings.chilled_water_design_kW, 0.1);
  const double people = drawings.occupancy_person_m2 * drawings.floor_area_m2();
  drawings.hot_water_m3_day =
      std::max(0.1, rounded((drawings.use == Use::laboratory ? 0.015 : 0.004) * people, 0.1));
  drawings.electricity_rated_kW = rounded(2.0 * connected_kW(drawings), 10.0);
  drawings.cooling_rated_kW = rounded(1.7 * coils_kW, 10.0);
  drawings.heat_rated_kW = rounded(2.8 * drawings.heating_design_kW, 10.0);
}

Drawings draw_up(const Brief& brief) {
  Drawings drawings;
  drawings.use = drawings.calendar = brief.use;
  drawings.storeys = brief.storeys;
  drawings.length_m = brief.length_m;
  drawings.width_m = brief.width_m;
  drawings.storey_height_m = brief.use == Use::laboratory ? 4.2 : 3.8;
  drawings.perimeter_depth_m = std::min(6.0, 0.3 * brief.width_m);
  drawings.window_share = brief.window_share;
  drawings.skylight_share = brief.skylight_share;
  drawings.heavy = brief.heavy;
  drawings.cooling = brief.cooling;
  drawings.heating = brief.heating;
  // What runs, loses heat or keeps people away unknown to the drawings would be a hidden effect.
  drawings.saturday_operation = false;
  drawings.attendance_follows_season = false;
  drawings.heating_efficiency = brief.heating == HeatingPlant::boiler ? 0.86 : 0.97;
  if (brief.use == Use::office) use_as_office(drawings);
  if (brief.use == Use::school) use_as_school(drawings);
  // Even where the core is thin, somebody works there.
  const double perimeter_share = 1.0 - drawings.core_and_special_m2() / drawings.storey_m2();
  drawings.perimeter_rooms.crowding =
      std::min(drawings.perimeter_rooms.crowding, 0.9 / perimeter_share);
  place_in(drawings, brief.climate);
  describe(drawings);
  size_services(drawings);
  return drawings;
}

}  // namespace recald::simulators
