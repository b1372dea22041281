#include "simulators/energyplus/parts/building_parts.hpp"

#include <cmath>

namespace recald::simulators::energyplus {
namespace {

constexpr std::string_view kAnyNumber = "Any number";
constexpr std::string_view kFaceNames[kFaces] = {"south", "north",   "east",
                                                 "west",  "ceiling", "floor"};
/// The face of the neighbour that a face touches.
constexpr Face kOpposite[kFaces] = {north, south, west, east, floor_face, ceiling};

using Point = std::array<double, 3>;

/// Counterclockwise as seen from outside, from the upper left corner.
std::array<Point, 4> corners(const Room& room, Face face) {
  const auto [x0, x1] = room.x_m;
  const auto [y0, y1] = room.y_m;
  const auto [z0, z1] = room.z_m;
  switch (face) {
    case south:
      return {{{x0, y0, z1}, {x0, y0, z0}, {x1, y0, z0}, {x1, y0, z1}}};
    case north:
      return {{{x1, y1, z1}, {x1, y1, z0}, {x0, y1, z0}, {x0, y1, z1}}};
    case east:
      return {{{x1, y0, z1}, {x1, y0, z0}, {x1, y1, z0}, {x1, y1, z1}}};
    case west:
      return {{{x0, y1, z1}, {x0, y1, z0}, {x0, y0, z0}, {x0, y0, z1}}};
    case ceiling:
      return {{{x0, y1, z1}, {x0, y0, z1}, {x1, y0, z1}, {x1, y1, z1}}};
    case floor_face:
      break;
  }
  return {{{x0, y0, z0}, {x0, y1, z0}, {x1, y1, z0}, {x1, y0, z0}}};
}

std::string surface_name(const std::string& room, Face face) {
  return room + " " + std::string{kFaceNames[face]};
}

void add_window(Json& model, const std::string& surface, const std::array<Point, 4>& wall,
                double share) {
  Json window = {{"surface_type", "Window"},
                 {"construction_name", "Window"},
                 {"building_surface_name", surface},
                 {"number_of_vertices", 4}};
  // The wall, drawn in towards its middle.
  const double scale = std::sqrt(share);
  for (std::size_t corner = 0; corner < wall.size(); ++corner) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double middle_m = 0.5 * (wall[0][axis] + wall[2][axis]);
      const std::string name =
          "vertex_" + std::to_string(corner + 1) + "_" + std::string{"xyz"[axis]} + "_coordinate";
      window[name] = middle_m + scale * (wall[corner][axis] - middle_m);
    }
  }
  model["FenestrationSurface:Detailed"][surface + " window"] = window;
}

std::string_view type_of(Face face, const Beyond& beyond) {
  if (face == ceiling) return beyond.what == Beyond::What::outdoors ? "Roof" : "Ceiling";
  return face == floor_face ? "Floor" : "Wall";
}

std::string_view construction_of(Face face, const Beyond& beyond) {
  if (beyond.what == Beyond::What::ground) return "Ground slab";
  const bool is_flat = face == ceiling || face == floor_face;
  if (beyond.what != Beyond::What::outdoors) return is_flat ? "Floor slab" : "Partition";
  return is_flat ? "Roof" : "Wall";
}

std::string_view boundary_of(Beyond::What what) {
  switch (what) {
    case Beyond::What::outdoors:
      return "Outdoors";
    case Beyond::What::ground:
      return "Ground";
    case Beyond::What::room:
      return "Surface";
    case Beyond::What::alike:
      break;
  }
  return "Adiabatic";
}

void add_surface(Json& model, const Room& room, Face face) {
  const Beyond& beyond = room.beyond[face];
  const bool is_outdoors = beyond.what == Beyond::What::outdoors;
  const std::string name = surface_name(room.name, face);
  const std::array<Point, 4> points = corners(room, face);
  Json surface = {{"surface_type", type_of(face, beyond)},
                  {"construction_name", construction_of(face, beyond)},
                  {"zone_name", room.name},
                  {"outside_boundary_condition", boundary_of(beyond.what)},
                  {"sun_exposure", is_outdoors ? "SunExposed" : "NoSun"},
                  {"wind_exposure", is_outdoors ? "WindExposed" : "NoWind"},
                  {"number_of_vertices", 4}};
  if (beyond.what == Beyond::What::room) {
    surface["outside_boundary_condition_object"] = surface_name(beyond.room, kOpposite[face]);
  }
  for (const auto& [x, y, z] : points) {
    surface["vertices"].push_back(
        {{"vertex_x_coordinate", x}, {"vertex_y_coordinate", y}, {"vertex_z_coordinate", z}});
  }
  model["BuildingSurface:Detailed"][name] = surface;
  if (beyond.window_share > 0.0) add_window(model, name, points, beyond.window_share);
}

void add_material(Json& model, const std::string& name, double thickness_m,
                  double conductivity_W_mK, double density_kg_m3, double heat_J_kgK,
                  double solar_absorptance) {
  model["Material"][name] = {{"roughness", "MediumRough"},
                             {"thickness", thickness_m},
                             {"conductivity", conductivity_W_mK},
                             {"density", density_kg_m3},
                             {"specific_heat", heat_J_kgK},
                             {"thermal_absorptance", 0.9},
                             {"solar_absorptance", solar_absorptance}};
}

void add_insulation(Json& model, const std::string& name, double resistance_m2K_W) {
  model["Material:NoMass"][name] = {{"roughness", "MediumRough"},
                                    {"thermal_resistance", resistance_m2K_W}};
}

std::string add_list(Json& model, const std::string& of, const std::vector<std::string>& rooms) {
  Json list = Json::array();
  for (const std::string& room : rooms) list.push_back({{"zone_name", room}});
  model["ZoneList"][of]["zones"] = list;
  return of;
}

void append_day(Json& data, std::string_view days, const HourlyShares& shares) {
  data.push_back({{"field", "For: " + std::string{days}}});
  for (std::size_t hour = 0; hour < shares.size(); ++hour) {
    const bool is_changed = hour + 1 == shares.size() || shares[hour + 1] != shares[hour];
    if (!is_changed) continue;
    data.push_back({{"field", "Until: " + std::to_string(hour + 1) + ":00"}});
    data.push_back({{"field", shares[hour]}});
  }
}

}  // namespace

Json empty_model(std::string_view building, double ground_C) {
  Json model;
  model["Version"]["Version 1"]["version_identifier"] = kVersion;
  model["SimulationControl"]["Control"] = {{"do_zone_sizing_calculation", "No"},
                                           {"do_system_sizing_calculation", "No"},
                                           {"do_plant_sizing_calculation", "No"},
                                           {"run_simulation_for_sizing_periods", "No"},
                                           {"run_simulation_for_weather_file_run_periods", "Yes"}};
  model["Building"][std::string{building}] = {{"terrain", "City"},
                                              {"solar_distribution", "FullExterior"},
                                              {"maximum_number_of_warmup_days", 25},
                                              {"minimum_number_of_warmup_days", 6}};
  model["Timestep"]["Timestep 1"]["number_of_timesteps_per_hour"] = 4;
  model["GlobalGeometryRules"]["Rules"] = {{"coordinate_system", "World"},
                                           {"starting_vertex_position", "UpperLeftCorner"},
                                           {"vertex_entry_direction", "Counterclockwise"}};
  model["RunPeriod"]["Year"] = {{"begin_month", 1},
                                {"begin_day_of_month", 1},
                                {"end_month", 12},
                                {"end_day_of_month", 31},
                                {"use_weather_file_daylight_saving_period", "Yes"},
                                {"use_weather_file_holidays_and_special_days", "Yes"}};
  Json& ground = model["Site:GroundTemperature:BuildingSurface"]["Ground"];
  for (const char* month : {"january", "february", "march", "april", "may", "june", "july",
                            "august", "september", "october", "november", "december"}) {
    ground[std::string{month} + "_ground_temperature"] = ground_C;
  }
  model["ScheduleTypeLimits"][std::string{kAnyNumber}] = Json::object();
  return model;
}

std::string add_constant(Json& model, const std::string& name, double value) {
  model["Schedule:Constant"][name] = {{"schedule_type_limits_name", kAnyNumber},
                                      {"hourly_value", value}};
  return name;
}

std::string add_weekly(Json& model, const std::string& name, const WeeklyShares& shares,
                       ColdDesignDay cold) {
  Json data = Json::array();
  data.push_back({{"field", "Through: 12/31"}});
  append_day(data,
             cold == ColdDesignDay::working ? "Weekdays SummerDesignDay WinterDesignDay"
                                            : "Weekdays SummerDesignDay",
             shares.workday);
  append_day(data, "Saturday", shares.saturday);
  append_day(data, "AllOtherDays", shares.sunday);
  model["Schedule:Compact"][name] = {{"schedule_type_limits_name", kAnyNumber}, {"data", data}};
  return name;
}

void add_constructions(Json& model, const Envelope& envelope) {
  add_material(model, "Brick", 0.10, 0.9, 1920.0, 790.0, envelope.wall_solar_absorptance);
  add_material(model, "Block", 0.15, 1.1, 1700.0, 900.0, 0.6);
  add_material(model, "Roof deck", 0.02, 0.2, 1100.0, 1000.0, envelope.roof_solar_absorptance);
  add_material(model, "Concrete", 0.15, 1.7, 2300.0, 900.0, 0.6);
  add_material(model, "Plasterboard", 0.0254, 0.16, 800.0, 1090.0, 0.5);
  add_insulation(model, "Wall insulation", envelope.wall_insulation_m2K_W);
  add_insulation(model, "Roof insulation", envelope.roof_insulation_m2K_W);
  add_insulation(model, "Ground insulation", envelope.ground_insulation_m2K_W);
  model["WindowMaterial:SimpleGlazingSystem"]["Glazing"] = {
      {"u_factor", envelope.window_u_W_m2K}, {"solar_heat_gain_coefficient", envelope.window_shgc}};
  Json& constructions = model["Construction"];
  constructions["Wall"] = {
      {"outside_layer", "Brick"}, {"layer_2", "Wall insulation"}, {"layer_3", "Block"}};
  constructions["Roof"] = {
      {"outside_layer", "Roof deck"}, {"layer_2", "Roof insulation"}, {"layer_3", "Concrete"}};
  constructions["Ground slab"] = {{"outside_layer", "Ground insulation"}, {"layer_2", "Concrete"}};
  constructions["Floor slab"] = {{"outside_layer", "Concrete"}};
  constructions["Partition"] = {{"outside_layer", "Plasterboard"}};
  constructions["Window"] = {{"outside_layer", "Glazing"}};
}

void add_room(Json& model, const Room& room) {
  model["Zone"][room.name] = {{"volume", room.volume_m3()}};
  if (room.multiplier > 1) model["Zone"][room.name]["multiplier"] = room.multiplier;
  for (std::size_t face = 0; face < kFaces; ++face) {
    add_surface(model, room, static_cast<Face>(face));
  }
}

void add_loads(Json& model, const RoomLoads& loads) {
  constexpr double kActivity_W = 130.0;  // Seated and standing work, ASHRAE Fundamentals.
  const std::string list = add_list(model, loads.of, loads.rooms);
  const std::string activity = add_constant(model, "Activity", kActivity_W);
  model["People"][loads.of + " people"] = {
      {"zone_or_zonelist_or_space_or_spacelist_name", list},
      {"number_of_people_schedule_name", loads.of + " presence"},
      {"number_of_people_calculation_method", "People/Area"},
      {"people_per_floor_area", loads.people_person_m2},
      {"sensible_heat_fraction", 0.58},
      {"activity_level_schedule_name", activity}};
  model["Lights"][loads.of + " lights"] = {{"zone_or_zonelist_or_space_or_spacelist_name", list},
                                           {"schedule_name", loads.of + " lights on"},
                                           {"design_level_calculation_method", "Watts/Area"},
                                           {"watts_per_floor_area", loads.lighting_W_m2},
                                           {"fraction_radiant", 0.4},
                                           {"fraction_visible", 0.2}};
  model["ElectricEquipment"][loads.of + " equipment"] = {
      {"zone_or_zonelist_or_space_or_spacelist_name", list},
      {"schedule_name", loads.of + " equipment on"},
      {"design_level_calculation_method", "Watts/Area"},
      {"watts_per_floor_area", loads.equipment_W_m2},
      {"fraction_radiant", 0.3}};
}

void add_infiltration(Json& model, const std::string& of, const std::vector<std::string>& rooms,
                      double flow_m3_s_m2) {
  const std::string always = add_constant(model, "Always", 1.0);
  // By the wind at the building alone: 1 at 4 m/s.
  constexpr double kPerWind_s_m = 0.25;
  model["ZoneInfiltration:DesignFlowRate"][of + " infiltration"] = {
      {"zone_or_zonelist_or_space_or_spacelist_name", add_list(model, of + " with facades", rooms)},
      {"schedule_name", always},
      {"design_flow_rate_calculation_method", "Flow/ExteriorArea"},
      {"flow_rate_per_exterior_surface_area", flow_m3_s_m2},
      {"constant_term_coefficient", 0.0},
      {"velocity_term_coefficient", kPerWind_s_m}};
}

void add_thermostats(Json& model, const std::vector<std::string>& rooms, double heating_C,
                     double cooling_C) {
  constexpr double kDualSetpoint = 4.0;  // A control type of EnergyPlus.
  const std::string heating = add_constant(model, "Heating set-point", heating_C);
  const std::string cooling = add_constant(model, "Cooling set-point", cooling_C);
  const std::string type = add_constant(model, "Thermostat type", kDualSetpoint);
  model["ThermostatSetpoint:DualSetpoint"]["Set-points"] = {
      {"heating_setpoint_temperature_schedule_name", heating},
      {"cooling_setpoint_temperature_schedule_name", cooling}};
  model["ZoneControl:Thermostat"]["Thermostats"] = {
      {"zone_or_zonelist_name", add_list(model, "Rooms with a thermostat", rooms)},
      {"control_type_schedule_name", type},
      {"control_1_object_type", "ThermostatSetpoint:DualSetpoint"},
      {"control_1_name", "Set-points"}};
}

}  // namespace recald::simulators::energyplus
