#include "simulators/energyplus/parts/plant_loop.hpp"

namespace recald::simulators::energyplus {
namespace {

/// Adds a branch with one component, and gives its name.
std::string add_branch(Json& model, const std::string& name, const std::string& type,
                       const std::string& component, const std::string& inlet,
                       const std::string& outlet) {
  model["Branch"][name]["components"].push_back({{"component_object_type", type},
                                                 {"component_name", component},
                                                 {"component_inlet_node_name", inlet},
                                                 {"component_outlet_node_name", outlet}});
  return name;
}

std::string add_pipe(Json& model, const std::string& name, const std::string& inlet,
                     const std::string& outlet) {
  model["Pipe:Adiabatic"][name] = {{"inlet_node_name", inlet}, {"outlet_node_name", outlet}};
  return add_branch(model, name + " branch", "Pipe:Adiabatic", name, inlet, outlet);
}

/// The coils' side of the loop: in, one branch a coil and a bypass, out.
void add_demand_side(Json& model, const std::string& name, const WaterLoop& loop) {
  const std::string first =
      add_pipe(model, name + " demand inlet pipe", name + " demand inlet", name + " to coils");
  const std::string last =
      add_pipe(model, name + " demand outlet pipe", name + " from coils", name + " demand outlet");
  std::vector<std::string> parallel;
  for (const LoopCoil& coil : loop.coils) {
    parallel.push_back(add_branch(model, coil.name + " water branch", coil.type, coil.name,
                                  coil.name + " water inlet", coil.name + " water outlet"));
  }
  parallel.push_back(
      add_pipe(model, name + " bypass", name + " bypass inlet", name + " bypass outlet"));
  Json branches = Json::array({{{"branch_name", first}}});
  Json outlets = Json::array();
  Json inlets = Json::array();
  for (const std::string& branch : parallel) {
    branches.push_back({{"branch_name", branch}});
    outlets.push_back({{"outlet_branch_name", branch}});
    inlets.push_back({{"inlet_branch_name", branch}});
  }
  branches.push_back({{"branch_name", last}});
  model["BranchList"][name + " demand branches"]["branches"] = branches;
  model["Connector:Splitter"][name + " splitter"] = {{"inlet_branch_name", first},
                                                     {"branches", outlets}};
  model["Connector:Mixer"][name + " mixer"] = {{"outlet_branch_name", last}, {"branches", inlets}};
  model["ConnectorList"][name + " connectors"] = {{"connector_1_object_type", "Connector:Splitter"},
                                                  {"connector_1_name", name + " splitter"},
                                                  {"connector_2_object_type", "Connector:Mixer"},
                                                  {"connector_2_name", name + " mixer"}};
}

/// Pump and district plant, one behind the other.
void add_supply_side(Json& model, const std::string& name, const WaterLoop& loop,
                     double water_m3_s) {
  // Far above what the coils can take: the network is never the limit.
  constexpr double kCapacity_W = 1e8;
  const bool cools = loop.of == WaterLoop::Of::cooling;
  const std::string type = cools ? "DistrictCooling" : "DistrictHeating:Water";
  const std::string plant = name + " district plant";
  const std::string water = cools ? "chilled_water" : "hot_water";
  const std::string inlet = name + " supply inlet";
  const std::string middle = name + " pump outlet";
  const std::string outlet = name + " supply outlet";
  constexpr double kPumpEfficiency = 0.6;  // Motor included.
  model["Pump:VariableSpeed"][name + " pump"] = {
      {"inlet_node_name", inlet},
      {"outlet_node_name", middle},
      {"design_maximum_flow_rate", water_m3_s},
      {"design_pump_head", loop.pump_head_Pa},
      {"design_power_consumption", water_m3_s * loop.pump_head_Pa / kPumpEfficiency},
      {"coefficient_1_of_the_part_load_performance_curve", 0.0},
      {"coefficient_2_of_the_part_load_performance_curve", 0.3},
      {"coefficient_3_of_the_part_load_performance_curve", 0.7},
      {"design_minimum_flow_rate", 0.0},
      {"pump_control_type", "Intermittent"}};
  model[type][plant] = {{water + "_inlet_node_name", middle},
                        {water + "_outlet_node_name", outlet},
                        {"nominal_capacity", kCapacity_W}};
  const std::string branch = name + " supply branch";
  add_branch(model, branch, "Pump:VariableSpeed", name + " pump", inlet, middle);
  add_branch(model, branch, type, plant, middle, outlet);
  model["BranchList"][name + " supply branches"]["branches"].push_back({{"branch_name", branch}});
  model["PlantEquipmentList"][name + " equipment"]["equipment"].push_back(
      {{"equipment_object_type", type}, {"equipment_name", plant}});
  const std::string operation =
      cools ? "PlantEquipmentOperation:CoolingLoad" : "PlantEquipmentOperation:HeatingLoad";
  model[operation][name + " operation"] = {{"load_range_1_lower_limit", 0.0},
                                           {"load_range_1_upper_limit", kCapacity_W},
                                           {"range_1_equipment_list_name", name + " equipment"}};
  model["PlantEquipmentOperationSchemes"][name + " schemes"] = {
      {"control_scheme_1_object_type", operation},
      {"control_scheme_1_name", name + " operation"},
      {"control_scheme_1_schedule_name", add_constant(model, "Always", 1.0)}};
}

}  // namespace

void add_water_loop(Json& model, const WaterLoop& loop) {
  const bool cools = loop.of == WaterLoop::Of::cooling;
  const std::string water = cools ? "Chilled water" : "Hot water";
  const std::string name = water + " loop";
  double water_m3_s = 0.0;
  for (const LoopCoil& coil : loop.coils) water_m3_s += coil.water_m3_s;
  add_supply_side(model, name, loop, water_m3_s);
  add_demand_side(model, name, loop);
  model["SetpointManager:Scheduled"][name + " set-point"] = {
      {"control_variable", "Temperature"},
      {"schedule_name", add_constant(model, water + " temperature", loop.supply_C)},
      {"setpoint_node_or_nodelist_name", name + " supply outlet"}};
  model["PlantLoop"][name] = {{"fluid_type", "Water"},
                              {"plant_equipment_operation_scheme_name", name + " schemes"},
                              {"loop_temperature_setpoint_node_name", name + " supply outlet"},
                              {"maximum_loop_temperature", 100.0},
                              {"minimum_loop_temperature", 1.0},
                              {"maximum_loop_flow_rate", water_m3_s},
                              {"minimum_loop_flow_rate", 0.0},
                              {"plant_loop_volume", "Autocalculate"},
                              {"plant_side_inlet_node_name", name + " supply inlet"},
                              {"plant_side_outlet_node_name", name + " supply outlet"},
                              {"plant_side_branch_list_name", name + " supply branches"},
                              {"demand_side_inlet_node_name", name + " demand inlet"},
                              {"demand_side_outlet_node_name", name + " demand outlet"},
                              {"demand_side_branch_list_name", name + " demand branches"},
                              {"demand_side_connector_list_name", name + " connectors"},
                              {"load_distribution_scheme", "Optimal"}};
}

}  // namespace recald::simulators::energyplus
