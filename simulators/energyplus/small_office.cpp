#include "simulators/energyplus/small_office.hpp"

namespace recald::simulators::energyplus {
namespace {

constexpr double kRoomLength_m = 24.0;
constexpr double kRoomWidth_m = 8.0;
constexpr double kRoomHeight_m = 3.2;

constexpr WeeklyShares kPeople{
    .workday = {0,   0,    0,    0,    0,    0,   0,    0.2, 0.6, 0.9, 0.9, 0.9,
                0.6, 0.85, 0.85, 0.85, 0.85, 0.4, 0.15, 0.1, 0,   0,   0,   0},
    .saturday = {0, 0, 0, 0, 0, 0, 0, 0, 0.1, 0.1, 0.1, 0.1, 0.1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    .sunday = {}};
/// The south room, then the north room.
std::vector<Room> two_rooms() {
  using What = Beyond::What;
  const Beyond facade{.what = What::outdoors, .room = {}, .window_share = 0.3};
  Room first{.name = "South room",
             .x_m = {0.0, kRoomLength_m},
             .y_m = {0.0, kRoomWidth_m},
             .z_m = {0.0, kRoomHeight_m},
             .beyond = {}};
  first.beyond = {facade,   Beyond{.what = What::room, .room = "North room"},
                  facade,   facade,
                  Beyond{}, Beyond{.what = What::ground}};
  Room second = first;
  second.name = "North room";
  second.y_m = {kRoomWidth_m, 2.0 * kRoomWidth_m};
  second.beyond[south] = Beyond{.what = What::room, .room = "South room"};
  second.beyond[north] = facade;
  return {first, second};
}

/// As much warm or cool air as is needed, and outdoor air for the people present.
void add_ideal_air(Json& model, const std::string& room, double supply_air_C) {
  const std::string system = room + " ideal air";
  model["ZoneHVAC:IdealLoadsAirSystem"][system] = {
      {"zone_supply_air_node_name", room + " supply"},
      {"maximum_heating_supply_air_temperature", 40.0},
      {"minimum_cooling_supply_air_temperature", supply_air_C},
      {"maximum_heating_supply_air_humidity_ratio", 0.0156},
      {"minimum_cooling_supply_air_humidity_ratio", 0.0085},
      {"dehumidification_control_type", "ConstantSupplyHumidityRatio"},
      {"design_specification_outdoor_air_object_name", "Outdoor air"},
      {"outdoor_air_economizer_type", "NoEconomizer"},
      {"demand_controlled_ventilation_type", "None"}};
  model["ZoneHVAC:EquipmentList"][room + " equipment list"]["equipment"].push_back(
      {{"zone_equipment_object_type", "ZoneHVAC:IdealLoadsAirSystem"},
       {"zone_equipment_name", system},
       {"zone_equipment_cooling_sequence", 1},
       {"zone_equipment_heating_or_no_load_sequence", 1}});
  model["ZoneHVAC:EquipmentConnections"][room + " connections"] = {
      {"zone_name", room},
      {"zone_conditioning_equipment_list_name", room + " equipment list"},
      {"zone_air_inlet_node_or_nodelist_name", room + " supply"},
      {"zone_air_node_name", room + " air"},
      {"zone_return_air_node_or_nodelist_name", room + " return"}};
}

}  // namespace

std::vector<PeopleSchedule> small_office_schedules() {
  return {{"Office presence", kPeople},
          {"Office lights on", kPeople, 0.06, 0.94},
          {"Office equipment on", kPeople, 0.30, 0.70}};
}

Json small_office_model(const SmallOfficeParameters& parameters) {
  Json model = empty_model("Small office", parameters.ground_C);
  add_constructions(model, parameters.envelope);
  std::vector<std::string> names;
  for (const Room& room : two_rooms()) {
    add_room(model, room);
    names.push_back(room.name);
  }
  for (const PeopleSchedule& schedule : small_office_schedules()) {
    add_weekly(model, schedule.name, schedule.weekly());
  }
  add_loads(model, {.of = "Office",
                    .rooms = names,
                    .people_person_m2 = parameters.person_m2,
                    .lighting_W_m2 = parameters.lighting_W_m2,
                    .equipment_W_m2 = parameters.equipment_W_m2});
  add_infiltration(model, "Office", names, parameters.infiltration_m3_s_m2);
  add_thermostats(model, names, parameters.heating_setpoint_C, parameters.cooling_setpoint_C);
  model["DesignSpecification:OutdoorAir"]["Outdoor air"] = {
      {"outdoor_air_method", "Flow/Person"},
      {"outdoor_air_flow_per_person", parameters.outdoor_m3_s_person},
      {"outdoor_air_schedule_name", "Office presence"}};
  for (const std::string& name : names) add_ideal_air(model, name, parameters.supply_air_C);
  return model;
}

}  // namespace recald::simulators::energyplus
