#include "adapters/energyplus/effect_patch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "adapters/energyplus/model/schedule_values.hpp"
#include "core/diagnosis/effects/support/effect.hpp"
#include "tests/support/sample_building.hpp"

namespace recald::energyplus {
namespace {

using ::testing::HasSubstr;

std::string day_rules(const std::string& working, const std::string& other) {
  return R"({"data": [{"field": "Through: 12/31"}, {"field": "For: Weekdays"},
    {"field": "Until: 7:00"}, {"field": )" +
         other + R"(}, {"field": "Until: 18:00"}, {"field": )" + working +
         R"(}, {"field": "Until: 24:00"}, {"field": )" + other +
         R"(}, {"field": "For: AllOtherDays"}, {"field": "Until: 24:00"}, {"field": )" + other +
         "}]}";
}

/// Two rooms with fans of variable speed, a thermostat, an economiser, people, lights and plugs.
ModelDocument office() {
  return {Json::parse(R"({
    "Schedule:Compact": {"Plant": )" +
                      day_rules("1", "0") + R"(, "Heating": )" + day_rules("21", "16") +
                      R"(, "Cooling": )" + day_rules("24", "30") + R"(, "Use": )" +
                      day_rules("0.9", "0.1") + R"(},
    "Zone": {"North": {"floor_area": 100}, "South": {"floor_area": 300}},
    "AvailabilityManager:Scheduled": {"Manager": {"schedule_name": "PLANT"}},
    "Fan:VariableVolume": {"Fan": {"availability_schedule_name": "Plant",
      "fan_power_coefficient_1": 0.1, "fan_power_coefficient_2": 0.2,
      "fan_power_coefficient_3": 0.7}},
    "ThermostatSetpoint:DualSetpoint": {"Rooms": {
      "heating_setpoint_temperature_schedule_name": "Heating",
      "cooling_setpoint_temperature_schedule_name": "Cooling"}},
    "Controller:OutdoorAir": {"Air": {"economizer_control_type": "FixedDryBulb",
      "minimum_outdoor_air_flow_rate": 1.0, "maximum_outdoor_air_flow_rate": 5.0}},
    "ZoneInfiltration:DesignFlowRate": {"Leak": {"design_flow_rate": 0.1}},
    "People": {"Staff": {"number_of_people_schedule_name": "Use"}},
    "Lights": {"Lamps": {"schedule_name": "Use", "watts_per_floor_area": 8,
      "design_level_calculation_method": "Watts/Area",
      "zone_or_zonelist_or_space_or_spacelist_name": "North"}},
    "ElectricEquipment": {
      "North plugs": {"schedule_name": "Use", "design_level_calculation_method": "Watts/Area",
        "watts_per_floor_area": 10, "zone_or_zonelist_or_space_or_spacelist_name": "North"},
      "South plugs": {"schedule_name": "Use", "design_level_calculation_method": "EquipmentLevel",
        "design_level": 3000, "zone_or_zonelist_or_space_or_spacelist_name": "South"}}
  })"),
          "25.2"};
}

/// The catalogue's parameters of an effect.
std::vector<std::string> names_of(std::string_view effect) {
  const auto building = recald::testing::sample_building();
  const auto drivers = recald::testing::sample_drivers(building, 1);
  std::vector<std::string> names;
  for (const auto& one : diagnosis::find_effect(effect)->parameters({building, drivers, {}, {}})) {
    names.push_back(one.name);
  }
  return names;
}

Json patched(const std::string& effect, std::vector<double> values) {
  const ModelDocument model = office();
  const auto patch = find_effect_patch(model, effect, names_of(effect));
  EXPECT_TRUE(patch) << patch.error().message;
  Json objects = model.objects;
  if (patch) patch->apply(values, objects);
  return objects;
}

/// A day of the schedule that a field names.
DayValues day_of(const Json& objects, const char* field, DayKind kind) {
  const std::string name = objects.at(Json::json_pointer{field}).get<std::string>();
  return read_schedule(objects, name)->spans[0].days[kind];
}

constexpr const char* kFan = "/Fan:VariableVolume/Fan/availability_schedule_name";
constexpr const char* kHeating =
    "/ThermostatSetpoint:DualSetpoint/Rooms/heating_setpoint_temperature_schedule_name";
constexpr const char* kCooling =
    "/ThermostatSetpoint:DualSetpoint/Rooms/cooling_setpoint_temperature_schedule_name";

TEST(EffectPatch, AWeekendRunsForAShareOfAWeekdaysHours) {
  const Json objects = patched("weekend_operation", {1.0, 0.5});
  EXPECT_EQ(day_of(objects, kFan, kSaturday), day_of(objects, kFan, kTuesday));
  EXPECT_EQ(day_of(objects, kFan, kSunday), (DayValues{{420, 0.0}, {750, 1.0}, {1440, 0.0}}));
  EXPECT_EQ(day_of(objects, kHeating, kSunday),
            (DayValues{{420, 16.0}, {750, 21.0}, {1440, 16.0}}));
  EXPECT_EQ(day_of(objects, kCooling, kSaturday), day_of(objects, kCooling, kMonday));
  EXPECT_EQ(day_of(objects, kFan, kHoliday), (DayValues{{1440, 0.0}})) << "a holiday is no weekend";
  EXPECT_EQ(objects["AvailabilityManager:Scheduled"]["Manager"]["schedule_name"],
            objects.at(Json::json_pointer{kFan}))
      << "one schedule, one copy";
  EXPECT_EQ(objects["Schedule:Compact"]["Plant"], office().objects["Schedule:Compact"]["Plant"]);
}

TEST(EffectPatch, LateStopsAndEarlyStartsMoveTheirOwnHalfOfAWorkingDay) {
  EXPECT_EQ(day_of(patched("after_hours", {2.5}), kFan, kThursday),
            (DayValues{{420, 0.0}, {1230, 1.0}, {1440, 0.0}}));
  EXPECT_EQ(day_of(patched("after_hours", {9.0}), kFan, kThursday),
            (DayValues{{420, 0.0}, {1440, 1.0}}))
      << "to the end of the day at most";
  EXPECT_EQ(day_of(patched("early_start", {1.0, 0.1}), kFan, kThursday),
            (DayValues{{270, 0.0}, {1080, 1.0}, {1440, 0.0}}))
      << "an hour, and 0.1 h for each of 15 K";
  EXPECT_EQ(day_of(patched("early_start", {1.0, 0.0}), kFan, kSunday), (DayValues{{1440, 0.0}}));
}

TEST(EffectPatch, AMissingSetBackKeepsRoomsNearerToTheDay) {
  const Json objects = patched("night_setback_missing", {0.4});
  EXPECT_EQ(day_of(objects, kHeating, kSunday), (DayValues{{1440, 18.0}}));
  EXPECT_DOUBLE_EQ(day_of(objects, kCooling, kMonday).front().value, 27.6);
  EXPECT_DOUBLE_EQ(day_of(objects, kHeating, kMonday)[1].value, 21.0);
}

TEST(EffectPatch, LoadsComeWhereEquipmentIs) {
  const Json objects = patched("server_room", {2.0, 0.5, 0.0});
  const Json& loads = objects["ElectricEquipment"];
  ASSERT_EQ(loads.size(), 4U);
  // 1 kW and 3 kW are there; 2 kW more in the same shares.
  EXPECT_DOUBLE_EQ(loads["North plugs server_room"]["watts_per_floor_area"], 5.0);
  EXPECT_DOUBLE_EQ(loads["South plugs server_room"]["design_level"], 1500.0);
  const std::string always = loads["South plugs server_room"]["schedule_name"];
  EXPECT_EQ(read_schedule(objects, always)->spans[0].days[kSunday], (DayValues{{1440, 1.0}}));
  EXPECT_EQ(loads["North plugs"], office().objects["ElectricEquipment"]["North plugs"]);

  // Of 4 kW, 0.9 for 11 hours of five days and else 0.1.
  const double mean_kW = 4.0 * (5.0 * (11.0 * 0.9 + 13.0 * 0.1) / 24.0 + 2.0 * 0.1) / 7.0;
  const Json step = patched("equipment_step", {1.0, 0.25})["ElectricEquipment"];
  EXPECT_NEAR(step["South plugs equipment_step"]["design_level"], 0.75 * 750.0, 1e-9);
  EXPECT_NEAR(step["South plugs equipment_step use"]["design_level"], 0.25 * 3000.0 / mean_kW,
              1e-9);
  EXPECT_EQ(step["South plugs equipment_step use"]["schedule_name"], "Use");
  const Json less = patched("equipment_step", {-1.0, 0.25})["ElectricEquipment"];
  EXPECT_NEAR(less["South plugs"]["design_level"], 3000.0 * (1.0 - 1.0 / mean_kW), 1e-9);
  EXPECT_NEAR(less["North plugs"]["watts_per_floor_area"], 10.0 * (1.0 - 1.0 / mean_kW), 1e-9);

  const Json lamps = patched("exterior_lighting", {1.5, 0.0})["Exterior:Lights"];
  EXPECT_DOUBLE_EQ(lamps.front()["design_level"], 1500.0);
  EXPECT_EQ(lamps.front()["control_option"], "AstronomicalClock");
}

TEST(EffectPatch, AirFansAndLeaksChangeByTheirShares) {
  EXPECT_DOUBLE_EQ(patched("economiser_failed",
                           {0.25})["Controller:OutdoorAir"]["Air"]["maximum_outdoor_air_flow_rate"],
                   4.0);
  EXPECT_EQ(patched("economiser_failed",
                    {1.0})["Controller:OutdoorAir"]["Air"]["economizer_control_type"],
            "NoEconomizer");
  EXPECT_DOUBLE_EQ(patched("outdoor_air_amount",
                           {-0.2})["Controller:OutdoorAir"]["Air"]["minimum_outdoor_air_flow_rate"],
                   0.8);
  const Json fan = patched("constant_speed_fans", {0.5})["Fan:VariableVolume"]["Fan"];
  EXPECT_DOUBLE_EQ(fan["fan_power_coefficient_1"], 0.55);
  EXPECT_DOUBLE_EQ(fan["fan_power_coefficient_3"], 0.35);
  // Of a leak that knows no wind, 0.2 for each m/s.
  EXPECT_DOUBLE_EQ(
      patched("wind_infiltration",
              {0.2, 1.0})["ZoneInfiltration:DesignFlowRate"]["Leak"]["velocity_term_coefficient"],
      0.2);
}

TEST(EffectPatch, AVacancyTakesPeopleAndWhatTheySwitchOn) {
  const Json objects = patched("vacancy", {0.5});
  EXPECT_DOUBLE_EQ(
      day_of(objects, "/People/Staff/number_of_people_schedule_name", kMonday)[1].value, 0.5);
  EXPECT_DOUBLE_EQ(day_of(objects, "/Lights/Lamps/schedule_name", kMonday)[1].value,
                   0.1 + 0.6 * 0.8);
  EXPECT_DOUBLE_EQ(day_of(objects, "/Lights/Lamps/schedule_name", kSunday)[0].value, 0.1)
      << "what never stops stays";
}

TEST(EffectPatch, NeutralValuesLeaveTheModelAsItIs) {
  const ModelDocument model = office();
  for (const char* effect : {"weekend_operation", "after_hours", "early_start",
                             "night_setback_missing", "economiser_failed", "vacancy"}) {
    EXPECT_EQ(patched(effect, {0.0, 0.0}), model.objects) << effect;
  }
}

TEST(EffectPatch, EachIsAnEffectOfTheCatalogue) {
  for (const std::string_view id : patched_effects()) {
    ASSERT_NE(diagnosis::find_effect(id), nullptr) << id;
    const auto patch = find_effect_patch(office(), id, names_of(id));
    EXPECT_TRUE(patch || patch.error().message.find("its parameter") == std::string::npos) << id;
  }
}

// Values come in the order of the names, whichever that is.
TEST(EffectPatch, ParametersAreJoinedByName) {
  const std::vector<std::string> turned{"sunday_share", "another", "saturday_share"};
  const ModelDocument model = office();
  const auto patch = find_effect_patch(model, "weekend_operation", turned);
  ASSERT_TRUE(patch.has_value()) << patch.error().message;
  Json objects = model.objects;
  patch->apply(std::vector<double>{0.5, 7.0, 1.0}, objects);
  EXPECT_EQ(objects, patched("weekend_operation", {1.0, 0.5}));
  const std::vector<std::string> others{"saturday_share", "another"};
  EXPECT_THAT(find_effect_patch(model, "weekend_operation", others).error().message,
              HasSubstr("'weekend_operation' comes without its parameter 'sunday_share'"));
}

TEST(EffectPatch, WhatCannotBePatchedIsSaid) {
  EXPECT_THAT(find_effect_patch(office(), "scale_fault", names_of("scale_fault")).error().message,
              HasSubstr("an EnergyPlus model cannot be given the effect 'scale_fault'"));
  ModelDocument bare = office();
  bare.objects.erase("Fan:VariableVolume");
  EXPECT_THAT(find_effect_patch(bare, "constant_speed_fans", names_of("constant_speed_fans"))
                  .error()
                  .message,
              HasSubstr("has nothing that the effect 'constant_speed_fans' would change"));
}

}  // namespace
}  // namespace recald::energyplus
