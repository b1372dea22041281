#include "simulators/energyplus/parts/air_handler.hpp"

#include <cmath>

#include "simulators/climate/air.hpp"

namespace recald::simulators::energyplus {
namespace {

constexpr double kAir_kg_m3 = 1.2;
constexpr double kAirHeat_J_m3K = kAir_kg_m3 * kDryAirHeat_J_kgK;
constexpr double kWaterHeat_J_m3K = 1000.0 * kWaterHeat_J_kgK;
constexpr double kChilledRise_K = 7.0;
constexpr double kHotDrop_K = 15.0;

/// Of moist air at the design hour, a day that is exceeded for a few hours a year.
constexpr AirState kHotDay{35.0, 0.0165};
constexpr AirState kReturn{25.0, 0.0095};
/// Colder and drier than the air that is supplied, so that the coil can still make the lowest
/// supply temperature that somebody may believe in.
constexpr AirState kOffCoil{10.5, 0.0076};
constexpr double kColdMixed_C = -8.0;

std::string node(const AirHandler& handler, const char* where) {
  return handler.name + " " + where;
}

/// Air is mixed, warmed, moved, cooled.
struct Nodes {
  explicit Nodes(const AirHandler& of)
      : returned(node(of, "return")),
        outdoor(node(of, "outdoor air")),
        relief(node(of, "relief air")),
        mixed(node(of, "mixed air")),
        preheated(node(of, "preheated air")),
        blown(node(of, "fan outlet")),
        supplied(node(of, "supply air")) {}
  std::string returned, outdoor, relief, mixed, preheated, blown, supplied;
};

void add_outdoor_air(Json& model, const AirHandler& handler, const Nodes& at) {
  const std::string controller = node(handler, "outdoor air controller");
  const std::string controllers = node(handler, "outdoor air controllers");
  const std::string parts = node(handler, "outdoor air parts");
  const std::string mixer = node(handler, "mixing box");
  model["OutdoorAir:NodeList"][handler.name]["nodes"].push_back(
      {{"node_or_nodelist_name", at.outdoor}});
  model["OutdoorAir:Mixer"][mixer] = {{"mixed_air_node_name", at.mixed},
                                      {"outdoor_air_stream_node_name", at.outdoor},
                                      {"relief_air_stream_node_name", at.relief},
                                      {"return_air_stream_node_name", at.returned}};
  model["Controller:OutdoorAir"][controller] = {
      {"relief_air_outlet_node_name", at.relief},
      {"return_air_node_name", at.returned},
      {"mixed_air_node_name", at.mixed},
      {"actuator_node_name", at.outdoor},
      {"minimum_outdoor_air_flow_rate", handler.outdoor_m3_s},
      // A model's user may raise the outdoor air, never above what is supplied.
      {"maximum_outdoor_air_flow_rate", handler.supply_m3_s()},
      {"economizer_control_type", "NoEconomizer"},
      {"minimum_limit_type", "FixedMinimum"},
      {"minimum_outdoor_air_schedule_name", handler.outdoor_schedule}};
  model["AirLoopHVAC:ControllerList"][controllers] = {
      {"controller_1_object_type", "Controller:OutdoorAir"}, {"controller_1_name", controller}};
  model["AirLoopHVAC:OutdoorAirSystem:EquipmentList"][parts] = {
      {"component_1_object_type", "OutdoorAir:Mixer"}, {"component_1_name", mixer}};
  model["AirLoopHVAC:OutdoorAirSystem"][node(handler, "outdoor air system")] = {
      {"controller_list_name", controllers}, {"outdoor_air_equipment_list_name", parts}};
}

/// A coil that makes this much heat with its air entering at `air_C`. EnergyPlus wants its UA.
LoopCoil add_heating_coil(Json& model, const std::string& name, double heat_W, double flow_m3_s,
                          double air_C, double hot_C, const std::string& inlet,
                          const std::string& outlet) {
  const double leaving_C = air_C + heat_W / (kAirHeat_J_m3K * flow_m3_s);
  const double hot_end_K = hot_C - leaving_C;
  const double cold_end_K = hot_C - kHotDrop_K - air_C;
  const double mean_K = 0.5 * (hot_end_K + cold_end_K);
  const double water_m3_s = heat_W / (kWaterHeat_J_m3K * kHotDrop_K);
  model["Coil:Heating:Water"][name] = {
      {"u_factor_times_area_value", heat_W / mean_K},
      {"maximum_water_flow_rate", water_m3_s},
      {"water_inlet_node_name", name + " water inlet"},
      {"water_outlet_node_name", name + " water outlet"},
      {"air_inlet_node_name", inlet},
      {"air_outlet_node_name", outlet},
      {"performance_input_method", "UFactorTimesAreaAndDesignWaterFlowRate"},
      {"rated_capacity", heat_W}};
  return {"Coil:Heating:Water", name, water_m3_s};
}

LoopCoil add_cooling_coil(Json& model, const AirHandler& handler, const WaterDesign& water,
                          const Nodes& at) {
  const std::string name = node(handler, "cooling coil");
  const double outdoor_share = std::min(1.2 * handler.outdoor_m3_s / handler.supply_m3_s(), 1.0);
  const AirState entering = mix(kHotDay, kReturn, outdoor_share);
  const double heat_W =
      kAir_kg_m3 * handler.supply_m3_s() * (enthalpy_J_kg(entering) - enthalpy_J_kg(kOffCoil));
  const double water_m3_s = heat_W / (kWaterHeat_J_m3K * kChilledRise_K);
  model["Coil:Cooling:Water"][name] = {
      {"design_water_flow_rate", water_m3_s},
      {"design_air_flow_rate", handler.supply_m3_s()},
      {"design_inlet_water_temperature", water.chilled_C},
      {"design_inlet_air_temperature", entering.temperature_C},
      {"design_outlet_air_temperature", kOffCoil.temperature_C},
      {"design_inlet_air_humidity_ratio", entering.humidity_kg_kg},
      {"design_outlet_air_humidity_ratio", kOffCoil.humidity_kg_kg},
      {"water_inlet_node_name", name + " water inlet"},
      {"water_outlet_node_name", name + " water outlet"},
      {"air_inlet_node_name", at.blown},
      {"air_outlet_node_name", at.supplied},
      {"type_of_analysis", "SimpleAnalysis"},
      {"heat_exchanger_configuration", "CrossFlow"}};
  return {"Coil:Cooling:Water", name, water_m3_s};
}

/// Holds a coil's air at the temperature of a schedule.
std::string add_coil_controller(Json& model, const LoopCoil& coil, const std::string& air_node,
                                const std::string& schedule) {
  const bool cools = coil.type == "Coil:Cooling:Water";
  const std::string name = coil.name + " controller";
  model["Controller:WaterCoil"][name] = {{"control_variable", "Temperature"},
                                         {"action", cools ? "Reverse" : "Normal"},
                                         {"actuator_variable", "Flow"},
                                         {"sensor_node_name", air_node},
                                         {"actuator_node_name", coil.name + " water inlet"},
                                         {"controller_convergence_tolerance", 0.05},
                                         {"maximum_actuated_flow", coil.water_m3_s},
                                         {"minimum_actuated_flow", 0.0}};
  model["SetpointManager:Scheduled"][coil.name + " set-point"] = {
      {"control_variable", "Temperature"},
      {"schedule_name", schedule},
      {"setpoint_node_or_nodelist_name", air_node}};
  return name;
}

void add_fan(Json& model, const AirHandler& handler, const Nodes& at) {
  model["Fan:VariableVolume"][node(handler, "fan")] = {
      {"fan_total_efficiency", 0.6},
      {"pressure_rise", handler.fan_pressure_Pa},
      {"maximum_flow_rate", handler.supply_m3_s()},
      {"fan_power_minimum_flow_rate_input_method", "Fraction"},
      {"fan_power_minimum_flow_fraction", 0.25},
      {"motor_efficiency", 0.93},
      {"motor_in_airstream_fraction", 1.0},
      // A fan with variable speed: ASHRAE 90.1, appendix G, part-load performance.
      {"fan_power_coefficient_1", 0.0013},
      {"fan_power_coefficient_2", 0.1470},
      {"fan_power_coefficient_3", 0.9506},
      {"fan_power_coefficient_4", -0.0998},
      {"fan_power_coefficient_5", 0.0},
      {"air_inlet_node_name", at.preheated},
      {"air_outlet_node_name", at.blown}};
}

/// The box of a room and all that EnergyPlus needs to find it.
LoopCoil add_terminal(Json& model, const AirHandler& handler, const Terminal& terminal,
                      double hot_C) {
  const std::string& room = terminal.room;
  const std::string box = room + " box";
  const std::string inlet = box + " inlet";
  const std::string damper = box + " damper outlet";
  const std::string outlet = room + " supply";
  const LoopCoil coil = add_heating_coil(model, room + " reheat coil", terminal.reheat_W,
                                         terminal.minimum_share * terminal.supply_m3_s,
                                         handler.supply_C, hot_C, damper, outlet);
  model["AirTerminal:SingleDuct:VAV:Reheat"][box] = {
      {"damper_air_outlet_node_name", damper},
      {"air_inlet_node_name", inlet},
      {"maximum_air_flow_rate", terminal.supply_m3_s},
      {"zone_minimum_air_flow_input_method", "Constant"},
      {"constant_minimum_air_flow_fraction", terminal.minimum_share},
      {"reheat_coil_object_type", coil.type},
      {"reheat_coil_name", coil.name},
      {"maximum_hot_water_or_steam_flow_rate", coil.water_m3_s},
      {"minimum_hot_water_or_steam_flow_rate", 0.0},
      {"air_outlet_node_name", outlet},
      {"damper_heating_action", "Normal"}};
  model["ZoneHVAC:AirDistributionUnit"][room + " air distribution"] = {
      {"air_distribution_unit_outlet_node_name", outlet},
      {"air_terminal_object_type", "AirTerminal:SingleDuct:VAV:Reheat"},
      {"air_terminal_name", box}};
  model["ZoneHVAC:EquipmentList"][room + " equipment list"]["equipment"].push_back(
      {{"zone_equipment_object_type", "ZoneHVAC:AirDistributionUnit"},
       {"zone_equipment_name", room + " air distribution"},
       {"zone_equipment_cooling_sequence", 1},
       {"zone_equipment_heating_or_no_load_sequence", 1}});
  model["ZoneHVAC:EquipmentConnections"][room + " connections"] = {
      {"zone_name", room},
      {"zone_conditioning_equipment_list_name", room + " equipment list"},
      {"zone_air_inlet_node_or_nodelist_name", outlet},
      {"zone_air_node_name", room + " air"},
      {"zone_return_air_node_or_nodelist_name", room + " return"}};
  return coil;
}

void add_ducts(Json& model, const AirHandler& handler, const Nodes& at) {
  const std::string to_rooms = node(handler, "to rooms");
  const std::string from_rooms = node(handler, "from rooms");
  const std::string splitter = node(handler, "splitter");
  const std::string mixer = node(handler, "return mixer");
  Json outlets = Json::array();
  Json inlets = Json::array();
  for (const Terminal& terminal : handler.terminals) {
    outlets.push_back({{"outlet_node_name", terminal.room + " box inlet"}});
    inlets.push_back({{"inlet_node_name", terminal.room + " return"}});
  }
  model["AirLoopHVAC:ZoneSplitter"][splitter] = {{"inlet_node_name", to_rooms}, {"nodes", outlets}};
  model["AirLoopHVAC:ZoneMixer"][mixer] = {{"outlet_node_name", from_rooms}, {"nodes", inlets}};
  model["AirLoopHVAC:SupplyPath"][node(handler, "supply path")] = {
      {"supply_air_path_inlet_node_name", to_rooms},
      {"components",
       {{{"component_object_type", "AirLoopHVAC:ZoneSplitter"}, {"component_name", splitter}}}}};
  model["AirLoopHVAC:ReturnPath"][node(handler, "return path")] = {
      {"return_air_path_outlet_node_name", from_rooms},
      {"components",
       {{{"component_object_type", "AirLoopHVAC:ZoneMixer"}, {"component_name", mixer}}}}};
  model["AirLoopHVAC"][handler.name] = {{"controller_list_name", node(handler, "coil controllers")},
                                        {"design_supply_air_flow_rate", handler.supply_m3_s()},
                                        {"branch_list_name", node(handler, "branches")},
                                        {"supply_side_inlet_node_name", at.returned},
                                        {"demand_side_outlet_node_name", from_rooms},
                                        {"demand_side_inlet_node_names", to_rooms},
                                        {"supply_side_outlet_node_names", at.supplied}};
}

void add_branch(Json& model, const AirHandler& handler, const Nodes& at, const LoopCoil& preheat,
                const LoopCoil& cooling) {
  Json& components = model["Branch"][node(handler, "branch")]["components"];
  const auto append = [&](const std::string& type, const std::string& name,
                          const std::string& inlet, const std::string& outlet) {
    components.push_back({{"component_object_type", type},
                          {"component_name", name},
                          {"component_inlet_node_name", inlet},
                          {"component_outlet_node_name", outlet}});
  };
  append("AirLoopHVAC:OutdoorAirSystem", node(handler, "outdoor air system"), at.returned,
         at.mixed);
  append(preheat.type, preheat.name, at.mixed, at.preheated);
  append("Fan:VariableVolume", node(handler, "fan"), at.preheated, at.blown);
  append(cooling.type, cooling.name, at.blown, at.supplied);
  model["BranchList"][node(handler, "branches")]["branches"].push_back(
      {{"branch_name", node(handler, "branch")}});
}

}  // namespace

double AirHandler::supply_m3_s() const {
  double sum_m3_s = 0.0;
  for (const Terminal& terminal : terminals) sum_m3_s += terminal.supply_m3_s;
  return sum_m3_s;
}

HandlerCoils add_air_handler(Json& model, const AirHandler& handler, const WaterDesign& water) {
  const Nodes at(handler);
  add_outdoor_air(model, handler, at);
  add_fan(model, handler, at);
  const double preheat_W =
      kAirHeat_J_m3K * handler.outdoor_m3_s * (handler.preheat_C - kColdMixed_C);
  HandlerCoils coils;
  coils.heating.push_back(add_heating_coil(model, node(handler, "preheat coil"), preheat_W,
                                           handler.supply_m3_s(), 0.0, water.hot_C, at.mixed,
                                           at.preheated));
  coils.cooling = add_cooling_coil(model, handler, water, at);
  const LoopCoil preheat = coils.heating.front();
  add_branch(model, handler, at, preheat, coils.cooling);
  model["AirLoopHVAC:ControllerList"][node(handler, "coil controllers")] = {
      {"controller_1_object_type", "Controller:WaterCoil"},
      {"controller_1_name",
       add_coil_controller(
           model, preheat, at.preheated,
           add_constant(model, node(handler, "preheat temperature"), handler.preheat_C))},
      {"controller_2_object_type", "Controller:WaterCoil"},
      {"controller_2_name",
       add_coil_controller(
           model, coils.cooling, at.supplied,
           add_constant(model, node(handler, "supply temperature"), handler.supply_C))}};
  for (const Terminal& terminal : handler.terminals) {
    coils.heating.push_back(add_terminal(model, handler, terminal, water.hot_C));
  }
  add_ducts(model, handler, at);
  return coils;
}

}  // namespace recald::simulators::energyplus
