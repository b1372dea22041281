#include "adapters/energyplus/model/component_sizes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace recald::energyplus::component_sizes_test {
namespace {

using ::testing::ElementsAre;

TEST(ComponentSizes, AutosizedFieldsGetTheirDesignSizes) {
  Json objects = Json::parse(R"({
    "Fan:VariableVolume": {"Supply Fan": {"maximum_flow_rate": "Autosize", "pressure_rise": 600}},
    "AirTerminal:SingleDuct:VAV:Reheat": {"Box 1": {"maximum_air_flow_rate": "autosize",
        "constant_minimum_air_flow_fraction": 0.1, "maximum_hot_water_or_steam_flow_rate": "Autosize"}},
    "CoolingTower:SingleSpeed": {"Tower": {"design_air_flow_rate": "Autosize"}}
  })");
  const FrozenSizes frozen = freeze_sizes(
      {{"Fan:VariableVolume", "SUPPLY FAN", "Design Size Maximum Flow Rate", 2.5},
       {"AirTerminal:SingleDuct:VAV:Reheat", "BOX 1", "Design Size Maximum Air Flow Rate", 0.6},
       {"AirTerminal:SingleDuct:VAV:Reheat", "BOX 1",
        "User-Specified Constant Minimum Air Flow Fraction", 0.1},
       {"AirTerminal:SingleDuct:VAV:Reheat", "BOX 1",
        "Design Size Maximum Hot Water or Steam Flow Rate", 0.0},
       {"CoolingTower:SingleSpeed", "TOWER", "Design Size Design Air Flow Rate", 9.0}},
      objects);
  EXPECT_EQ(frozen.frozen, 2);
  EXPECT_EQ(objects["Fan:VariableVolume"]["Supply Fan"]["maximum_flow_rate"], 2.5);
  EXPECT_EQ(objects["Fan:VariableVolume"]["Supply Fan"]["pressure_rise"], 600);
  EXPECT_EQ(objects["AirTerminal:SingleDuct:VAV:Reheat"]["Box 1"]["maximum_air_flow_rate"], 0.6);
  EXPECT_EQ(objects["CoolingTower:SingleSpeed"]["Tower"]["design_air_flow_rate"], "Autosize");
  EXPECT_THAT(
      frozen.left,
      ElementsAre("AirTerminal:SingleDuct:VAV:Reheat/Box 1/maximum_hot_water_or_steam_flow_rate"));
}

}  // namespace
}  // namespace recald::energyplus::component_sizes_test
