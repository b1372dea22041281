#include "daemon/site/config/building_config.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace recald::daemon {
namespace {

using model::Building;
using model::DayType;
using model::SurfaceKind;

constexpr NumberRange kTemperature_C{-40.0, 100.0};

double read_heat_capacity_J_m2K(TomlReader& table) {
  const auto mass = table.word("mass", {"very_light", "light", "medium", "heavy", "very_heavy"});
  using enum model::MassClass;
  if (mass == "very_light") return model::heat_capacity_J_m2K(very_light);
  if (mass == "light") return model::heat_capacity_J_m2K(light);
  if (mass == "heavy") return model::heat_capacity_J_m2K(heavy);
  if (mass == "very_heavy") return model::heat_capacity_J_m2K(very_heavy);
  return model::heat_capacity_J_m2K(medium);
}

model::Surface read_surface(TomlReader table) {
  model::Surface surface{};
  surface.name = table.required_text("name");
  const auto kind = table.word("kind", {"wall", "roof", "window", "ground"});
  if (!table.has("kind")) table.problem("'kind' is missing: wall, roof, window or ground");
  surface.kind = kind == "roof"     ? SurfaceKind::roof
                 : kind == "window" ? SurfaceKind::window
                 : kind == "ground" ? SurfaceKind::ground
                                    : SurfaceKind::wall;
  surface.area_m2 = table.required_number("area_m2", kPositive);
  surface.u_W_m2K = table.required_number("u_W_m2K", kPositive);
  const bool upright = kind == "wall" || kind == "window";
  surface.orientation.tilt_deg = table.number_or("tilt_deg", upright ? 90.0 : 0.0, {0.0, 180.0});
  const auto azimuth_deg = table.number("azimuth_deg", {0.0, 360.0});
  if (!table.has("azimuth_deg") && surface.orientation.tilt_deg > 0.0) {
    table.problem(
        "'azimuth_deg' is missing: the direction the surface faces, clockwise from north");
  }
  // A flat surface faces nowhere: all of them share one orientation.
  surface.orientation.azimuth_deg =
      surface.orientation.tilt_deg > 0.0 ? azimuth_deg.value_or(0.0) : 0.0;
  surface.solar_absorptance = table.number_or("solar_absorptance", 0.6, kShare);
  surface.emissivity = table.number_or("emissivity", 0.9, kShare);
  if (surface.kind == SurfaceKind::window) {
    surface.shgc = table.required_number("shgc", kShare);
    surface.frame_fraction = table.number_or("frame_fraction", 0.2, kShare);
    surface.shading_factor = table.number_or("shading_factor", 1.0, kShare);
  }
  table.finish();
  return surface;
}

void read_use(TomlReader table, model::Use& use) {
  use.occupancy_person_m2 = table.required_number("occupancy_person_m2", kNotNegative);
  use.sensible_W_person = table.number_or("sensible_W_person", use.sensible_W_person, kNotNegative);
  use.latent_W_person = table.number_or("latent_W_person", use.latent_W_person, kNotNegative);
  use.lighting_W_m2 = table.required_number("lighting_W_m2", kNotNegative);
  use.plugs_W_m2 = table.required_number("plugs_W_m2", kNotNegative);
  use.exterior_kW = table.number_or("exterior_kW", 0.0, kNotNegative);
  use.zone_heat_share = table.number_or("zone_heat_share", use.zone_heat_share, kShare);
  table.finish();
}

/// @param whole  Every kind of day has to be there; else nobody is in on those that are not.
void read_schedule(TomlReader table, model::HourlySchedule& occupied_fraction, bool whole) {
  const auto read_day = [&](std::string_view key, DayType day) {
    const auto values = table.numbers(key, 24, kShare);
    if (!values) {
      if (table.has(key) || !whole) return;
      table.problem(fmt::format("'{}' must list the occupied fraction of each hour 0 to 23", key));
      return;
    }
    for (int hour = 0; hour < 24; ++hour) {
      occupied_fraction.at(day, hour) = (*values)[static_cast<std::size_t>(hour)];
    }
  };
  read_day("workday", DayType::workday);
  read_day("saturday", DayType::saturday);
  read_day("sunday", DayType::sunday_or_holiday);
  table.finish();
}

std::chrono::month_day read_month_day(TomlReader& table, std::string_view key) {
  const std::string text = table.required_text(key);
  // Any leap year will do.
  const auto day = metering::parse_day("2020-" + text);
  if (day) return {day->month(), day->day()};
  if (!text.empty()) {
    table.problem_at(
        key, fmt::format("'{}' is \"{}\"; write a day of the year such as \"07-15\"", key, text));
  }
  return {};
}

model::Season read_season(TomlReader& table) {
  model::Season season{.first = read_month_day(table, "from"),
                       .last = read_month_day(table, "to"),
                       .occupied_fraction = {},
                       .closed = table.boolean("closed").value_or(false),
                       .heating = table.boolean("heating").value_or(true),
                       .cooling = table.boolean("cooling").value_or(true)};
  if (season.closed) season.occupied_fraction.emplace();
  if (auto schedule = table.table("schedule")) {
    read_schedule(*schedule, season.occupied_fraction.emplace(), /*whole=*/false);
  }
  if (!season.has_own_use() && season.heating && season.cooling) {
    table.problem(
        "a season says nothing; give it closed = true, heating = false, cooling = false, or a "
        "schedule of its own");
  }
  table.finish();
  return season;
}

void read_set_points(TomlReader table, model::SetPoints& set) {
  set.cooling_occupied_C =
      table.number_or("cooling_occupied_C", set.cooling_occupied_C, kTemperature_C);
  set.cooling_unoccupied_C =
      table.number_or("cooling_unoccupied_C", set.cooling_unoccupied_C, kTemperature_C);
  set.heating_occupied_C =
      table.number_or("heating_occupied_C", set.heating_occupied_C, kTemperature_C);
  set.heating_unoccupied_C =
      table.number_or("heating_unoccupied_C", set.heating_unoccupied_C, kTemperature_C);
  constexpr NumberRange hours{0.0, 24.0};
  set.occupied_from_hour = table.whole_number_or("occupied_from", 7, hours);
  set.occupied_to_hour = table.whole_number_or("occupied_to", 19, hours);
  set.saturday_occupied = table.boolean("saturday_occupied").value_or(false);
  set.sunday_occupied = table.boolean("sunday_occupied").value_or(false);
  if (set.heating_occupied_C >= set.cooling_occupied_C) {
    table.problem(
        fmt::format("the heating set-point {} degC is not below the cooling set-point {} degC; "
                    "they would work against each other",
                    set.heating_occupied_C, set.cooling_occupied_C));
  }
  table.finish();
}

model::AirSystem read_air(TomlReader table) {
  model::AirSystem air;
  air.has_reheat_boxes = table.boolean("reheat_boxes").value_or(true);
  air.outdoor_air_m3_s = table.required_number("outdoor_air_m3_s", kNotNegative);
  air.outdoor_air_unoccupied_fraction =
      table.number_or("outdoor_air_unoccupied_fraction", 0.0, kShare);
  air.supply_flow_design_m3_s = table.required_number("supply_flow_design_m3_s", kPositive);
  // Units in rooms have no least flow.
  air.supply_flow_min_m3_s = air.has_reheat_boxes
                                 ? table.required_number("supply_flow_min_m3_s", kNotNegative)
                                 : table.number_or("supply_flow_min_m3_s", 0.0, kNotNegative);
  air.supply_temperature_C = table.number_or("supply_temperature_C", 13.0, {5.0, 25.0});
  air.fan_design_kW = table.required_number("fan_design_kW", kNotNegative);
  air.pump_design_kW = table.number_or("pump_design_kW", 0.0, kNotNegative);
  air.heat_recovery = table.number_or("heat_recovery", 0.0, kShare);
  air.economiser_lockout_C = table.number("economiser_lockout_C", kTemperature_C);
  air.humidification_kg_kg = table.number("humidification_kg_kg", {0.0, 0.02});
  if (air.supply_flow_min_m3_s > air.supply_flow_design_m3_s) {
    table.problem("'supply_flow_min_m3_s' is larger than 'supply_flow_design_m3_s'");
  }
  table.finish();
  return air;
}

void read_plant(TomlReader& table, Building& building) {
  if (auto heating = table.table("heating")) {
    building.heating_loss_fraction = heating->number_or("loss_fraction", 0.0, kShare);
    building.heating_efficiency = heating->number_or("efficiency", 1.0, {0.05, 10.0});
    building.base_heat_kW = heating->number_or("base_heat_kW", 0.0, kNotNegative);
    heating->finish();
  }
  if (auto cooling = table.table("cooling")) {
    building.cooling_loss_fraction = cooling->number_or("loss_fraction", 0.0, kShare);
    building.chiller_cop = cooling->number("chiller_cop", {0.5, 20.0});
    building.cooling_idle_kW = cooling->number_or("idle_kW", 0.0, kNotNegative);
    if (building.cooling_idle_kW > 0.0 && !building.chiller_cop) {
      cooling->problem("'idle_kW' is that of an own chiller; give its 'chiller_cop' too");
    }
    cooling->finish();
  }
  if (auto water = table.table("hot_water")) {
    model::HotWater& hot_water = building.hot_water;
    hot_water.volume_m3_day = water->required_number("volume_m3_day", kNotNegative);
    hot_water.temperature_C = water->number_or("temperature_C", 55.0, kTemperature_C);
    hot_water.mains_C = water->number_or("mains_C", 12.0, kTemperature_C);
    hot_water.mains_amplitude_K = water->number_or("mains_amplitude_K", 0.0, {0.0, 20.0});
    hot_water.efficiency = water->number_or("efficiency", 0.9, {0.05, 1.0});
    water->finish();
  }
}

}  // namespace

Building read_building(TomlReader table) {
  Building building;
  building.floor_area_m2 = table.required_number("floor_area_m2", kPositive);
  building.storeys = table.whole_number_or("storeys", 1, {1.0, 200.0});
  building.storey_height_m = table.number_or("storey_height_m", 3.0, {1.5, 30.0});
  building.heat_capacity_J_m2K = read_heat_capacity_J_m2K(table);
  building.ventilation_m3_s = table.number_or("ventilation_m3_s", 0.0, kNotNegative);
  for (TomlReader& surface : table.tables("surface")) {
    building.surfaces.push_back(read_surface(surface));
  }
  if (building.surfaces.empty()) {
    table.problem("a building needs at least one [[building.surface]]");
  }
  if (auto use = table.table("use")) {
    read_use(*use, building.use);
  } else {
    table.problem("[building.use] is missing");
  }
  if (auto schedule = table.table("schedule")) {
    read_schedule(*schedule, building.occupied_fraction, /*whole=*/true);
  } else {
    table.problem("[building.schedule] is missing");
  }
  for (TomlReader& season : table.tables("season")) {
    building.seasons.push_back(read_season(season));
  }
  if (auto set_points = table.table("setpoint")) read_set_points(*set_points, building.set_points);
  if (auto infiltration = table.table("infiltration")) {
    building.leakage_cm2_m2 = infiltration->number_or("ela_cm2_m2", 1.0, kNotNegative);
    infiltration->finish();
  }
  if (auto air = table.table("air")) building.air = read_air(*air);
  read_plant(table, building);
  if (auto ground = table.table("ground")) {
    building.ground_temperature_C = ground->number_or("temperature_C", 12.0, kTemperature_C);
    ground->finish();
  }
  table.finish();
  return building;
}

}  // namespace recald::daemon
