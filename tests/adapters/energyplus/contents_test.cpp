#include "adapters/energyplus/contents.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "adapters/sqlite/tables/database.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::energyplus::contents_test {
namespace {

using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> names_of(const std::vector<ReportedMeter>& meters) {
  std::vector<std::string> names;
  for (const ReportedMeter& meter : meters) names.push_back(meter.name);
  return names;
}

TEST(Contents, MetersOfTheWholeBuildingComeFirst) {
  const TemporaryFolder folder;
  write_text(folder.path() / "eplusout.mdd",
             "Program Version,EnergyPlus, Version 25.2.0\n"
             "Var Type (reported time step),Var Report Type,Variable Name [Units]\n"
             "Zone,Meter,Electricity:Zone:CORE [J]\n"
             "Zone,Meter,Electricity:Building [J]\n"
             "Zone,Meter,GeneralLights:InteriorLights:Electricity [J]\n"
             "Zone,Meter,InteriorLights:Electricity [J]\n"
             "Zone,Meter,NaturalGas:Facility [J]\n"
             "Zone,Meter,Water:Facility [m3]\n"
             "HVAC,Meter,CoolingCoils:EnergyTransfer [J]\n"
             "Zone,Meter,Electricity:Facility [J]\n"
             "HVAC,Meter,Electricity:Facility [J]\n");
  const auto meters = what_is_reported(folder.path());
  ASSERT_TRUE(meters.has_value()) << meters.error().message;
  EXPECT_THAT(
      names_of(*meters),
      ElementsAre("Electricity:Facility", "NaturalGas:Facility", "InteriorLights:Electricity",
                  "CoolingCoils:EnergyTransfer", "GeneralLights:InteriorLights:Electricity",
                  "Electricity:Building", "Electricity:Zone:CORE"));
  const ReportedMeter& lights = (*meters)[4];
  EXPECT_EQ(lights.resource, "Electricity");
  EXPECT_EQ(lights.end_use, "GeneralLights:InteriorLights");
  EXPECT_EQ(meters->back().where, "Zone:CORE");
  EXPECT_FALSE(lights.total_kWh.has_value());
}

TEST(Contents, TotalsAreThoseOfTheRun) {
  const TemporaryFolder folder;
  {
    auto database = sqlite::Database::open(folder.path() / "eplusout.sql", {}).value();
    ASSERT_TRUE(database.execute(R"(
      CREATE TABLE ReportDataDictionary(ReportDataDictionaryIndex, IsMeter, Name, Units);
      CREATE TABLE ReportData(ReportDataDictionaryIndex, TimeIndex, Value);
      CREATE TABLE Time(TimeIndex, EnvironmentPeriodIndex, WarmupFlag);
      CREATE TABLE EnvironmentPeriods(EnvironmentPeriodIndex, EnvironmentType);
      INSERT INTO EnvironmentPeriods VALUES (1, 1), (2, 3);
      INSERT INTO Time VALUES (1, 1, 0), (2, 2, 1), (3, 2, 0), (4, 2, NULL);
      INSERT INTO ReportDataDictionary VALUES (7, 1, 'Electricity:Facility', 'J'),
        (8, 1, 'Electricity:Facility', 'J'), (9, 0, 'Zone Air Temperature', 'C');
      INSERT INTO ReportData VALUES (7, 1, 9e9), (7, 2, 9e9), (7, 3, 3.6e6), (7, 4, 7.2e6),
        (8, 1, 9e9), (8, 2, 9e9), (8, 4, 10.8e6), (9, 4, 20);)"));
  }
  const auto meters = what_is_reported(folder.path());
  ASSERT_TRUE(meters.has_value()) << meters.error().message;
  EXPECT_THAT(names_of(*meters), ElementsAre("Electricity:Facility"));
  EXPECT_DOUBLE_EQ(*meters->front().total_kWh, 3.0);
}

TEST(Contents, ARunThatWasNotAskedIsSaid) {
  const TemporaryFolder folder;
  const auto meters = what_is_reported(folder.path());
  ASSERT_FALSE(meters.has_value());
  EXPECT_EQ(meters.error().code, ErrorCode::not_found);
  Json objects = Json::parse(R"({"OutputControl:Files": {"recald": {"output_mdd": "No"}}})");
  ask_for_meters(objects);
  EXPECT_EQ(objects["OutputControl:Files"]["recald"]["output_mdd"], "Yes");
  EXPECT_EQ(objects["Output:VariableDictionary"].size(), 1u);
}

TEST(Contents, NumbersOfSubstanceAndPlantCouldBeVaried) {
  const auto model = parse_epjson(R"({
    "Version": {"v": {"version_identifier": "25.2"}},
    "Building": {"b": {"north_axis": 30}},
    "Schedule:Constant": {"s": {"hourly_value": 1}},
    "Lights": {"a": {"watts_per_floor_area": 10, "schedule_name": "s"},
               "b": {"watts_per_floor_area": 4}, "c": {"lighting_level": 300}},
    "Fan:VariableVolume": {"f": {"maximum_flow_rate": "Autosize", "pressure_rise": 600,
                                 "fan_power_coefficient_1": 0.1}},
    "ZoneHVAC:EquipmentList": {"l": {"zone_equipment_cooling_sequence": 1}}
  })",
                                  "m");
  const auto fields = what_could_be_varied(*model);
  std::vector<std::string> patterns;
  for (const VariableField& field : fields) patterns.push_back(field.pattern);
  ASSERT_THAT(patterns, ElementsAre("Lights/*/watts_per_floor_area", "Lights/*/lighting_level",
                                    "Fan:VariableVolume/*/pressure_rise"));
  EXPECT_EQ(fields[0].objects, 2u);
  EXPECT_EQ(fields[0].smallest, 4.0);
  EXPECT_EQ(fields[0].largest, 10.0);
  EXPECT_EQ(paste_lines(fields[2]),
            "[[model.parameter]]\nname = \"fan_variablevolume_pressure_rise\"\n"
            "targets = [\"Fan:VariableVolume/*/pressure_rise\"]\nchange = \"scale\"\n"
            "prior = [0.9, 1.0, 1.1]\n");
  ModelDocument glass = *model;
  glass.objects["Material"]["Brick"]["conductivity"] = 0.8;
  EXPECT_EQ(paste_lines(find_known_parameter(glass, "conductivity_scale").value()),
            "[[model.parameter]]\nname = \"conductivity_scale\"\nprior = [0.85, 1, 1.15]\n");
}

}  // namespace
}  // namespace recald::energyplus::contents_test
