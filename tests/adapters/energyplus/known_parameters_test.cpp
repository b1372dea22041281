#include "adapters/energyplus/known_parameters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "adapters/energyplus/model/role_schedules.hpp"

namespace recald::energyplus::known_parameters_test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// Two rooms of 10 by 10 and 10 by 5 m; the set-points share a schedule with each other's role,
/// with a heater of water, and with a fan.
constexpr std::string_view kModel = R"({
  "Version": {"Version 1": {"version_identifier": "25.2"}},
  "Zone": {"Hall": {}, "Shop": {"multiplier": 2}},
  "ZoneList": {"Both": {"zones": [{"zone_name": "HALL"}, {"zone_name": "Shop"}]}},
  "BuildingSurface:Detailed": {
    "Hall floor": {"surface_type": "Floor", "zone_name": "Hall", "outside_boundary_condition": "Ground",
      "vertices": [
        {"vertex_x_coordinate": 0, "vertex_y_coordinate": 0, "vertex_z_coordinate": 0},
        {"vertex_x_coordinate": 0, "vertex_y_coordinate": 10, "vertex_z_coordinate": 0},
        {"vertex_x_coordinate": 10, "vertex_y_coordinate": 10, "vertex_z_coordinate": 0},
        {"vertex_x_coordinate": 10, "vertex_y_coordinate": 0, "vertex_z_coordinate": 0}]},
    "Shop floor": {"surface_type": "Floor", "zone_name": "Shop", "outside_boundary_condition": "Ground",
      "vertices": [
        {"vertex_x_coordinate": 10, "vertex_y_coordinate": 0, "vertex_z_coordinate": 1},
        {"vertex_x_coordinate": 10, "vertex_y_coordinate": 10, "vertex_z_coordinate": 1},
        {"vertex_x_coordinate": 15, "vertex_y_coordinate": 10, "vertex_z_coordinate": 1},
        {"vertex_x_coordinate": 15, "vertex_y_coordinate": 0, "vertex_z_coordinate": 1}]},
    "Wall": {"surface_type": "Wall", "zone_name": "Hall", "outside_boundary_condition": "Outdoors",
      "vertices": [
        {"vertex_x_coordinate": 0, "vertex_y_coordinate": 0, "vertex_z_coordinate": 4},
        {"vertex_x_coordinate": 0, "vertex_y_coordinate": 0, "vertex_z_coordinate": 0},
        {"vertex_x_coordinate": 10, "vertex_y_coordinate": 0, "vertex_z_coordinate": 0},
        {"vertex_x_coordinate": 10, "vertex_y_coordinate": 0, "vertex_z_coordinate": 4}]}},
  "People": {
    "Guests": {"zone_or_zonelist_or_space_or_spacelist_name": "hall", "number_of_people": 6,
      "number_of_people_calculation_method": "People", "people_per_floor_area": 9.0},
    "Staff": {"zone_or_zonelist_or_space_or_spacelist_name": "Shop", "floor_area_per_person": 25,
      "number_of_people_calculation_method": "Area/Person"}},
  "Lights": {"All": {"zone_or_zonelist_or_space_or_spacelist_name": "Both", "lighting_level": 500}},
  "ElectricEquipment:ITE:AirCooled": {"Racks": {"zone_or_space_name": "Hall", "watts_per_unit": 400,
    "number_of_units": 5}},
  "ZoneInfiltration:EffectiveLeakageArea": {"Cracks": {"zone_or_space_name": "Hall",
    "effective_air_leakage_area": 100}},
  "ZoneInfiltration:DesignFlowRate": {"Doors": {"design_flow_rate": 0.1}},
  "Material": {"Brick": {"thickness": 0.2, "conductivity": 0.8, "density": 1600, "specific_heat": 900,
    "thermal_absorptance": 0.95}},
  "Material:NoMass": {"Board": {"thermal_resistance": 2.0}},
  "WindowMaterial:Glazing": {"Clear": {"solar_transmittance_at_normal_incidence": 0.9,
    "front_side_solar_reflectance_at_normal_incidence": 0.09,
    "back_side_solar_reflectance_at_normal_incidence": 0.05,
    "infrared_transmittance_at_normal_incidence": 0.0}},
  "Site:GroundTemperature:BuildingSurface": {"g": {"january_ground_temperature": 14.0,
    "july_ground_temperature": 18.0}},
  "DesignSpecification:OutdoorAir": {"Fresh": {"outdoor_air_method": "Sum",
    "outdoor_air_flow_per_person": 0.01, "outdoor_air_flow_per_zone_floor_area": 0.001,
    "outdoor_air_flow_per_zone": 0.0}},
  "Sizing:Zone": {"s": {"zone_or_zonelist_name": "Both",
    "design_specification_outdoor_air_object_name": "FRESH"}},
  "Controller:OutdoorAir": {"c": {"minimum_outdoor_air_flow_rate": "Autosize",
    "maximum_outdoor_air_flow_rate": 2.0}},
  "ZoneControl:Thermostat": {"t": {"control_1_object_type": "ThermostatSetpoint:DualSetpoint",
    "control_1_name": "Dual", "zone_or_zonelist_name": "Both"}},
  "ThermostatSetpoint:DualSetpoint": {
    "Dual": {"heating_setpoint_temperature_schedule_name": "WARM",
      "cooling_setpoint_temperature_schedule_name": "Cool"},
    "Unused": {"heating_setpoint_temperature_schedule_name": "Cool",
      "cooling_setpoint_temperature_schedule_name": "Cool"}},
  "WaterHeater:Mixed": {"Tank": {"ambient_temperature_schedule_name": "Warm"}},
  "Schedule:Compact": {"Cool": {"data": [{"field": "Through: 12/31"}, {"field": "For: Weekdays"},
      {"field": "Until: 18:00"}, {"field": 24.0}, {"field": "Until: 24:00"}, {"field": 30.0},
      {"field": "For: AllOtherDays"}, {"field": "Until: 24:00"}, {"field": 99.0}]}},
  "Schedule:Year": {"Warm": {"schedule_weeks": [{"schedule_week_name": "Warm", "start_month": 1}]}},
  "Schedule:Week:Compact": {"Warm": {"data": [{"daytype_list": "AllDays", "schedule_day_name": "Warm day"}]}},
  "Schedule:Day:Interval": {"Warm day": {"data": [{"time": "06:00", "value_until_time": 16.0},
    {"time": "24:00", "value_until_time": 21.0}]}}
})";

/// The same with an air loop and a plant loop.
constexpr std::string_view kPlant = R"({
  "AirLoopHVAC": {"Air": {"supply_side_outlet_node_names": "Air out"}},
  "NodeList": {"Air nodes": {"nodes": [{"node_name": "Coil out"}, {"node_name": "AIR OUT"}]}},
  "PlantLoop": {"Chilled": {"loop_temperature_setpoint_node_name": "Water out"},
                "Tower": {"loop_temperature_setpoint_node_name": "Tower out"}},
  "Sizing:Plant": {"a": {"loop_type": "Cooling", "plant_or_condenser_loop_name": "chilled"},
                   "b": {"loop_type": "Condenser", "plant_or_condenser_loop_name": "Tower"}},
  "SetpointManager:Scheduled": {
    "m1": {"control_variable": "Temperature", "schedule_name": "Seven",
           "setpoint_node_or_nodelist_name": "Water out"},
    "m2": {"control_variable": "Temperature", "schedule_name": "Seven",
           "setpoint_node_or_nodelist_name": "Tower out"}},
  "SetpointManager:Warmest": {"m3": {"minimum_setpoint_temperature": 12.5,
    "setpoint_node_or_nodelist_name": "Air nodes"}},
  "Schedule:Constant": {"Seven": {"hourly_value": 7.0}},
  "AirTerminal:SingleDuct:VAV:Reheat": {
    "b1": {"maximum_air_flow_rate": 2.0, "constant_minimum_air_flow_fraction": 0.3}},
  "Coil:Heating:Fuel": {"h": {}},
  "Chiller:Electric:EIR": {"k": {"reference_cop": 5.0}}
})";

ModelDocument model() {
  ModelDocument document = parse_epjson(kModel, "hall.epJSON").value();
  document.objects.update(Json::parse(kPlant));
  prepare_for_parameters(document);
  return document;
}

KnownParameter parameter(std::string_view name) {
  auto found = find_known_parameter(model(), name);
  EXPECT_TRUE(found.has_value()) << found.error().message;
  return *found;
}

/// The model with one parameter moved.
Json moved(std::string_view name, double value) {
  const KnownParameter known = parameter(name);
  Json objects = model().objects;
  for (const Target& target : known.targets)
    apply(target, known.change, known.amount(value), objects);
  return objects;
}

TEST(KnownParameters, APeopleDensityIsThatOfTheRoomsAndMovesEachObjectInItsOwnWay) {
  // 6 people and 2 shops of 50 m2 at 25 m2 each, over 200 m2.
  EXPECT_DOUBLE_EQ(parameter("occupancy_density").design, 10.0 / 200.0);
  const Json half = moved("occupancy_density", 0.025);
  EXPECT_DOUBLE_EQ(half["People"]["Guests"]["number_of_people"], 3.0);
  EXPECT_DOUBLE_EQ(half["People"]["Guests"]["people_per_floor_area"], 9.0);  // not in use
  EXPECT_DOUBLE_EQ(half["People"]["Staff"]["floor_area_per_person"], 50.0);
  EXPECT_GT(moved("occupancy_density", 0.0)["People"]["Staff"]["floor_area_per_person"], 1e6);
}

TEST(KnownParameters, PowerPerAreaCountsListsMultipliersAndServers) {
  EXPECT_DOUBLE_EQ(parameter("lighting_power").design, 1500.0 / 200.0);
  EXPECT_DOUBLE_EQ(parameter("equipment_power").design, 2000.0 / 100.0);
  EXPECT_DOUBLE_EQ(
      moved("equipment_power", 10.0)["ElectricEquipment:ITE:AirCooled"]["Racks"]["watts_per_unit"],
      200.0);
}

TEST(KnownParameters, ASharedScheduleIsCopiedForItsRoleWithItsDays) {
  const ModelDocument document = model();
  const Json& dual = document.objects["ThermostatSetpoint:DualSetpoint"];
  EXPECT_EQ(dual["Dual"]["heating_setpoint_temperature_schedule_name"], "Warm heating_setpoint");
  EXPECT_EQ(dual["Dual"]["cooling_setpoint_temperature_schedule_name"], "Cool cooling_setpoint");
  EXPECT_EQ(dual["Unused"]["cooling_setpoint_temperature_schedule_name"], "Cool");
  const Json warmer = moved("heating_setpoint", 22.0);
  const auto day = [&](const char* name) { return warmer["Schedule:Day:Interval"][name]["data"]; };
  EXPECT_DOUBLE_EQ(day("Warm day heating_setpoint")[0]["value_until_time"], 17.0);
  EXPECT_DOUBLE_EQ(day("Warm day heating_setpoint")[1]["value_until_time"], 22.0);
  EXPECT_DOUBLE_EQ(day("Warm day")[1]["value_until_time"], 21.0);
  EXPECT_EQ(
      warmer["Schedule:Week:Compact"]["Warm heating_setpoint"]["data"][0]["schedule_day_name"],
      "Warm day heating_setpoint");
  ModelDocument again = document;
  split_schedules(again);
  EXPECT_EQ(again.objects, document.objects);
}

TEST(KnownParameters, ASetPointMovesItsNumbersTogetherAndLeavesWhatMeansOff) {
  EXPECT_DOUBLE_EQ(parameter("cooling_setpoint").design, 24.0);
  EXPECT_EQ(parameter("cooling_setpoint").parameter.prior, (Prior{20.0, 24.0, 27.8}));
  const Json warmer = moved("cooling_setpoint", 25.5);
  const Json& data = warmer["Schedule:Compact"]["Cool cooling_setpoint"]["data"];
  EXPECT_DOUBLE_EQ(data[3]["field"], 25.5);
  EXPECT_DOUBLE_EQ(data[5]["field"], 31.5);
  EXPECT_DOUBLE_EQ(data[8]["field"], 99.0);
  EXPECT_EQ(data[2]["field"], "Until: 18:00");
}

TEST(KnownParameters, WaterAndAirAreThoseThatLeaveTheLoops) {
  EXPECT_DOUBLE_EQ(parameter("chilled_water_temperature").design, 7.0);
  const Json colder = moved("chilled_water_temperature", 6.0);
  EXPECT_EQ(colder["Schedule:Constant"]["Seven"]["hourly_value"], 7.0);  // the tower's
  EXPECT_EQ(colder["Schedule:Constant"]["Seven chilled_water_temperature"]["hourly_value"], 6.0);
  const Json air = moved("supply_temperature", 13.5);
  EXPECT_DOUBLE_EQ(air["SetpointManager:Warmest"]["m3"]["minimum_setpoint_temperature"], 13.5);
  EXPECT_DOUBLE_EQ(air["SetpointManager:Warmest"]["m3"]["maximum_setpoint_temperature"], 19.0);
}

TEST(KnownParameters, AirFlowsAreInTheirUnit) {
  // 10 people at 10 l/s and 200 m2 at 1 l/s.
  EXPECT_DOUBLE_EQ(parameter("outdoor_airflow").design, 0.1 + 0.2);
  EXPECT_DOUBLE_EQ(parameter("minimum_supply_flow").design, 0.6);
  EXPECT_DOUBLE_EQ(parameter("leakage_area").design, 100.0 / 40.0);
  EXPECT_DOUBLE_EQ(parameter("infiltration_scale").design, 1.0);
}

TEST(KnownParameters, MaterialsArePhysicalAndHaveTheirDefaults) {
  const Json darker = moved("thermal_absorptance_scale", 1.12);
  EXPECT_DOUBLE_EQ(darker["Material"]["Brick"]["thermal_absorptance"], 0.99999);
  EXPECT_DOUBLE_EQ(
      moved("solar_absorptance_scale", 0.9)["Material:NoMass"]["Board"]["solar_absorptance"], 0.63);
  EXPECT_DOUBLE_EQ(moved("heating_efficiency", 0.9)["Coil:Heating:Fuel"]["h"]["burner_efficiency"],
                   0.9);
  EXPECT_DOUBLE_EQ(moved("cooling_cop", 4.0)["Chiller:Electric:EIR"]["k"]["reference_cop"], 4.0);
  EXPECT_DOUBLE_EQ(
      moved("ground_temperature",
            17.0)["Site:GroundTemperature:BuildingSurface"]["g"]["july_ground_temperature"],
      19.0);
  // Emissivity 0.84: 0.16 is reflected.
  EXPECT_DOUBLE_EQ(
      moved("thermal_reflectance_scale",
            0.5)["WindowMaterial:Glazing"]["Clear"]["front_side_infrared_hemispherical_emissivity"],
      0.92);
}

TEST(KnownParameters, WhatTheModelDoesNotHaveIsSaid) {
  const auto zero = find_known_parameter(model(), "infrared_transmittance_scale");
  ASSERT_FALSE(zero.has_value());
  EXPECT_EQ(zero.error().code, ErrorCode::unsupported);
  EXPECT_THAT(zero.error().message, HasSubstr("this model has no such quantity"));
  const auto wrong = find_known_parameter(model(), "lighting_pwer");
  ASSERT_FALSE(wrong.has_value());
  EXPECT_EQ(wrong.error().code, ErrorCode::not_found);
  EXPECT_THAT(wrong.error().message, HasSubstr("did you mean 'lighting_power'?"));
  EXPECT_EQ(find_known_parameter(model(), "shgc_scale").error().code, ErrorCode::unsupported);
  std::vector<std::string> names;
  for (const KnownParameter& known : known_parameters(model()))
    names.push_back(known.parameter.name);
  EXPECT_THAT(names, Contains("density_scale"));
  EXPECT_THAT(names, Not(Contains("shgc_scale")));
}

TEST(KnownParameters, TogetherTheyStayPossible) {
  Json objects = model().objects;
  for (const auto& [name, value] : {std::pair{"cooling_setpoint", 20.0},
                                    {"heating_setpoint", 22.0},
                                    {"solar_transmittance_scale", 1.03}}) {
    const KnownParameter known = parameter(name);
    for (const Target& target : known.targets)
      apply(target, known.change, known.amount(value), objects);
  }
  objects["Controller:OutdoorAir"]["c"]["minimum_outdoor_air_flow_rate"] = 2.5;
  settle(model().objects, objects);
  const Json& day = objects["Schedule:Day:Interval"]["Warm day heating_setpoint"]["data"];
  EXPECT_DOUBLE_EQ(day[0]["value_until_time"], 17.0);
  EXPECT_DOUBLE_EQ(day[1]["value_until_time"], 19.0);
  const Json& pane = objects["WindowMaterial:Glazing"]["Clear"];
  EXPECT_NEAR(pane["front_side_solar_reflectance_at_normal_incidence"], 1.0 - 0.927, 1e-4);
  EXPECT_DOUBLE_EQ(pane["back_side_solar_reflectance_at_normal_incidence"], 0.05);
  EXPECT_DOUBLE_EQ(objects["Controller:OutdoorAir"]["c"]["minimum_outdoor_air_flow_rate"], 2.0);
}

}  // namespace
}  // namespace recald::energyplus::known_parameters_test
