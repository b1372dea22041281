#include "simulators/scenario/scenario_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace recald::simulators::scenario_file_test {
namespace {

using namespace std::chrono;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::HasSubstr;

class ScenarioFile : public ::testing::Test {
 protected:
  Result<Scenario> read(const std::string& text) {
    write_text(folder_ / "scenario.toml", text);
    return read_scenario(folder_ / "scenario.toml");
  }
  /// The sentence with which the text is refused.
  std::string refusal(const std::string& text) {
    const auto scenario = read(text);
    return scenario ? "accepted" : scenario.error().message;
  }

  TemporaryFolder folder_;
};

TEST_F(ScenarioFile, SaysWhatStandsWhereAndWhatIsHidden) {
  const auto scenario = read(R"([building]
use = "school"
storeys = 2
length_m = 80
width_m = 40
skylight_share = 0.1
mass = "light"
window_shgc = 0.5
[climate]
name = "cold"
[plant]
cooling = "chiller"
heating = "boiler"
chiller_cop = 4.5
[controls]
occupied_to_h = 18
[calendar]
of = "office"
[meters]
care = "gaps"
[period]
start = 2019
years = 2
step = "15m"
[[effect]]
name = "after_hours"
strength = 2.5
from = "2019-06-01"
[[effect]]
name = "scale_fault"
meter = "gas"
from = "2020-02-03"
[[decoy]]
name = "neighbour_meter"
)");
  ASSERT_TRUE(scenario) << scenario.error().message;
  EXPECT_EQ(scenario->drawings.use, Use::school);
  EXPECT_EQ(scenario->drawings.floor_area_m2(), 6400.0);
  EXPECT_EQ(scenario->drawings.heating, HeatingPlant::boiler);
  EXPECT_EQ(scenario->drawings.chiller_cop, 4.5);
  EXPECT_EQ(scenario->drawings.window_shgc, 0.5);
  EXPECT_EQ(scenario->drawings.occupied_to_h, 18.0);
  EXPECT_EQ(scenario->drawings.calendar, Use::office);
  EXPECT_FALSE(scenario->drawings.heavy);
  EXPECT_EQ(scenario->care, MeterCare::gaps);
  EXPECT_EQ(scenario->period.years, 2);
  EXPECT_EQ(scenario->step, 900s);
  ASSERT_EQ(scenario->effects.size(), 2u);
  EXPECT_EQ(scenario->effects[0].kind->id, "after_hours");
  EXPECT_EQ(scenario->effects[0].strength, 2.5);
  EXPECT_EQ(scenario->effects[0].from, metering::Day{2019y / June / 1});
  EXPECT_EQ(scenario->effects[1].meter, Utility::heat);
  EXPECT_EQ(scenario->effects[1].strength, scenario->effects[1].kind->strength.typical);
  EXPECT_TRUE(has_decoy(*scenario, Decoy::neighbour_meter));
}

TEST_F(ScenarioFile, AnEmptyFileIsAnOfficeOfTheMixedClimate) {
  const auto scenario = read("");
  ASSERT_TRUE(scenario) << scenario.error().message;
  EXPECT_EQ(scenario->drawings.use, Use::office);
  EXPECT_TRUE(scenario->effects.empty());
}

TEST_F(ScenarioFile, EveryUseHasSizeAndPlantOfItsOwn) {
  for (const Use use : kUses) {
    const auto scenario = read("[building]\nuse = \"" + std::string(to_string(use)) + "\"\n");
    ASSERT_TRUE(scenario) << scenario.error().message;
    EXPECT_EQ(scenario->drawings.use, use);
    EXPECT_EQ(scenario->drawings.calendar, use);
  }
  const auto shop = read("[building]\nuse = \"shop\"\nvintage = \"1980s\"\n");
  ASSERT_TRUE(shop) << shop.error().message;
  EXPECT_EQ(shop->drawings.cooling, CoolingPlant::packaged);
  EXPECT_EQ(shop->drawings.heating, HeatingPlant::boiler);
  EXPECT_EQ(shop->drawings.storeys, 1u);
  EXPECT_GT(shop->drawings.wall_u_W_m2K, 0.6);
  const auto warehouse =
      read("[building]\nuse = \"warehouse\"\n[controls]\nheating_setpoint_C = 16.5\n");
  ASSERT_TRUE(warehouse) << warehouse.error().message;
  EXPECT_EQ(warehouse->drawings.heating_setpoint_C, 16.5);
}

TEST_F(ScenarioFile, RefusesWhatAUseDoesNotHave) {
  EXPECT_THAT(refusal("[building]\nuse = \"hotel\"\n[controls]\noccupied_to_h = 20\n"),
              HasSubstr("[controls] unknown key 'occupied_to_h'"));
  EXPECT_THAT(refusal("[building]\nuse = \"hotel\"\n[[effect]]\nname = \"after_hours\"\n"),
              HasSubstr("needs air handlers that stop at night"));
  EXPECT_THAT(refusal("[building]\nuse = \"shop\"\n[[effect]]\nname = \"deep_drying\"\n"),
              HasSubstr("needs a chilled-water meter"));
  EXPECT_THAT(refusal("[building]\nuse = \"shop\"\n[[effect]]\nname = \"scale_fault\"\n"
                      "from = \"2021-05-01\"\nmeter = \"chilled_water\"\n"),
              HasSubstr("has no meter chilled_water; it has electricity, gas"));
  EXPECT_THAT(refusal("[controls]\nheating_setpoint_C = 16\n"),
              HasSubstr("'heating_setpoint_C' is 16; it must be between 20.3 and 21.9"));
}

TEST_F(ScenarioFile, RefusesWithOneSentence) {
  EXPECT_THAT(read_scenario(folder_ / "absent.toml").error().message, HasSubstr("check its path"));
  EXPECT_THAT(refusal("[building\n"), HasSubstr("scenario.toml:1: not valid TOML"));
  EXPECT_THAT(
      refusal("[building]\nstoreis = 3\n"),
      HasSubstr("scenario.toml:2: [building] unknown key 'storeis'; did you mean 'storeys'?"));
  EXPECT_THAT(refusal("[bilding]\n"), HasSubstr("unknown key 'bilding'; did you mean 'building'?"));
  EXPECT_THAT(refusal("[building]\nstoreys = 0\n"),
              HasSubstr("[building] 'storeys' is 0; it must be between 1 and 40"));
  EXPECT_THAT(refusal("[building]\nwidth_m = \"wide\"\n"),
              HasSubstr("[building] 'width_m' must be a number"));
  EXPECT_THAT(refusal("[building]\nuse = \"palace\"\n"),
              HasSubstr("'use' is \"palace\"; it must be one of laboratory, office, school"));
  EXPECT_THAT(refusal("[climate]\nname = \"lunar\"\n"), HasSubstr("one of hot-humid, hot-dry"));
  EXPECT_THAT(refusal("building = 3\n"), HasSubstr("'building' must be a table"));
  EXPECT_THAT(refusal("effect = \"after_hours\"\n"), HasSubstr("each headed [[effect]]"));
  EXPECT_THAT(refusal("[[effect]]\nname = \"after_hours\"\nfrom = \"soon\"\n"),
              HasSubstr("[effect] 'from': "));
}

TEST_F(ScenarioFile, RefusesEffectsThatCannotBe) {
  EXPECT_THAT(refusal("[[effect]]\nname = \"night_setback_mising\"\n"),
              HasSubstr("did you mean night_setback_missing?"));
  EXPECT_THAT(refusal("[[effect]]\nname = \"night_setback_missing\"\nstrength = 1.5\n"),
              HasSubstr("strength 1.5 is outside 0 to 1"));
  EXPECT_THAT(refusal("[[effect]]\nname = \"after_hours\"\n[[effect]]\nname = \"after_hours\"\n"),
              HasSubstr("contradict each other: both turn fan hours in the evening"));
  EXPECT_THAT(refusal("[[effect]]\nname = \"chiller_part_load\"\n"),
              HasSubstr("needs an own chiller: set cooling = \"chiller\" in [plant]"));
  EXPECT_THAT(refusal("[plant]\nheating = \"heat_pump\"\n[[effect]]\nname = \"steam_trap_leak\"\n"),
              HasSubstr("needs a heat meter"));
  EXPECT_THAT(
      refusal("[climate]\nname = \"hot-humid\"\n[[effect]]\nname = \"economiser_failed\"\n"),
      HasSubstr("needs an economiser"));
  EXPECT_THAT(refusal("[[effect]]\nname = \"scale_fault\"\nfrom = \"2021-05-01\"\n"),
              HasSubstr("is in one meter"));
  EXPECT_THAT(
      refusal("[[effect]]\nname = \"scale_fault\"\nfrom = \"2021-05-01\"\nmeter = \"gas\"\n"),
      HasSubstr("has no meter gas; it has chilled_water, electricity, heating"));
  EXPECT_THAT(refusal("[[effect]]\nname = \"after_hours\"\nmeter = \"electricity\"\n"),
              HasSubstr("leave meter out"));
  EXPECT_THAT(refusal("[[effect]]\nname = \"after_hours\"\nfrom = \"2030-01-01\"\n"),
              HasSubstr("lies outside the period 2021 to 2023"));
  EXPECT_THAT(read_scenario(folder_.path()).error().message, HasSubstr("check its path"));
  EXPECT_THAT(refusal("[[effect]]\nname = \"equipment_step\"\n"), HasSubstr("begins at a date"));
  EXPECT_THAT(
      refusal("[[effect]]\nname = \"vacancy\"\nfrom = \"2021-05-01\"\nto = \"2021-04-01\"\n"),
      HasSubstr("lies before from"));
}

}  // namespace
}  // namespace recald::simulators::scenario_file_test
