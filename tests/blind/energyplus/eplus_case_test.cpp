/// The world of EnergyPlus: what populations are made of, and a case from its seed.
#include "tests/blind/energyplus/eplus_case.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "simulators/scenario/archetypes.hpp"
#include "tests/blind/energyplus/foreign_building.hpp"
#include "tests/blind/population/written_answers.hpp"
#include "tests/support/installed_energyplus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::blind::eplus_case_test {
namespace {

using recald::testing::read_text;
using recald::testing::TemporaryFolder;
using simulators::energyplus::hidden_change;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<EplusCasePlan> plans_of(const char* name, std::uint64_t seed) {
  return plan_eplus(*population_kind("energyplus", name), seed);
}

template <class Values>
std::set<int> as_set(const Values& values) {
  std::set<int> set;
  for (const auto value : values) set.insert(static_cast<int>(value));
  return set;
}

template <class Of>
void expect_apart(const Of& of) {
  const std::set<int> learning = as_set(of(Family::learning));
  for (const int value : as_set(of(Family::judging))) EXPECT_FALSE(learning.contains(value));
}

TEST(Families, ShareNoUseNoShapeAndNoSystem) {
  expect_apart(uses_of);
  expect_apart(shapes_of);
  expect_apart(systems_of);
  EXPECT_GE(uses_of(Family::judging).size(), 4u);
}

TEST(Families, AreDrawnFromTheirOwnLists) {
  for (const Family family : {Family::learning, Family::judging}) {
    std::set<int> uses;
    std::set<int> systems;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      Rng rng{seed, 1};
      const auto building = draw_eplus_building(family, rng);
      uses.insert(static_cast<int>(building.drawings.use));
      systems.insert(static_cast<int>(building.system));
      EXPECT_TRUE(as_set(shapes_of(family)).contains(static_cast<int>(building.shape)));
    }
    EXPECT_EQ(uses, as_set(uses_of(family)));
    EXPECT_EQ(systems, as_set(systems_of(family)));
  }
}

TEST(EplusPlans, NumbersOfCasesDoNotTellTheirKinds) {
  const auto kinds = simulators::effect_kinds();
  double alike = 0.0;
  double again = 0.0;
  double pairs = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<std::string> wanted;
    for (const EplusCasePlan& plan : plans_of("sealed", seed)) {
      if (plan.block == Block::single) wanted.push_back(plan.candidates.front());
    }
    const auto round = std::set<std::string>(wanted.begin(), wanted.end()).size();
    const auto class_of = [&](std::size_t i) {
      return std::ranges::find(kinds, wanted[i], &simulators::EffectKind::id)->group;
    };
    for (std::size_t i = round; i < wanted.size(); ++i) {
      alike += class_of(i) == class_of(i - 1) ? 1.0 : 0.0;
      again += wanted[i] == wanted[i - round] ? 1.0 : 0.0;
      pairs += 1.0;
    }
  }
  // Of two kinds drawn at random, one pair in eight shares a class; in the catalogue's order two in
  // seven do.
  EXPECT_NEAR(alike / pairs, 0.13, 0.05);
  EXPECT_LT(again / pairs, 0.1);
}

TEST(EplusPlans, HaveTheSizesOfTheProtocol) {
  const auto plans = plans_of("sealed", 1);
  std::map<Block, int> blocks;
  std::map<double, int> bins;
  int in_forecast_year = 0;
  int hidden = 0;
  for (const EplusCasePlan& plan : plans) {
    ++blocks[plan.block];
    if (plan.block == Block::single) ++bins[plan.wanted.least];
    if (plan.block == Block::no_effect) continue;
    ++hidden;
    in_forecast_year += plan.begins_in_forecast_year ? 1 : 0;
  }
  EXPECT_GE(blocks[Block::no_effect], 100);
  EXPECT_GE(bins[0.1], 60);
  EXPECT_GE(bins[0.03], 60);
  EXPECT_GE(bins[0.005], 40);
  EXPECT_NEAR(in_forecast_year, 0.25 * hidden, 25.0);
  EXPECT_EQ(population_kind("energyplus", "secret").error().message,
            "unknown population secret; there are smoke, development, learning, sealed and, of our "
            "own world, plain");
}

TEST(EplusPlans, JudgeWithModelsOfOthersToo) {
  int foreign = 0;
  for (const EplusCasePlan& plan : plans_of("sealed", 3)) foreign += plan.building.foreign ? 1 : 0;
  EXPECT_NEAR(foreign, 140, 30);
  for (const char* name : {"smoke", "development", "learning"}) {
    for (const EplusCasePlan& plan : plans_of(name, 3)) EXPECT_FALSE(plan.building.foreign);
  }
}

TEST(Foreign, ModelsGrowWithTheirTotals) {
  Json model;
  model["Zone"]["Room"] = {{"x_origin", 2.0}, {"z_origin", 3.0}};
  model["BuildingSurface:Detailed"]["Wall"]["vertices"] = {
      {{"vertex_x_coordinate", 10.0}, {"vertex_y_coordinate", 0.0}, {"vertex_z_coordinate", 3.0}}};
  model["Exterior:Lights"]["Lamp"]["design_level"] = 100.0;
  const Json larger = altered(model, Rng{4, 1});
  EXPECT_EQ(larger, altered(model, Rng{4, 1}));
  EXPECT_NE(larger, altered(model, Rng{5, 1}));
  const double length = larger["Zone"]["Room"]["x_origin"].get<double>() / 2.0;
  EXPECT_NE(length, 1.0);
  EXPECT_EQ(larger["Zone"]["Room"]["z_origin"], 3.0);
  const Json& corner = larger["BuildingSurface:Detailed"]["Wall"]["vertices"][0];
  EXPECT_EQ(corner["vertex_x_coordinate"], 10.0 * length);
  EXPECT_EQ(corner["vertex_z_coordinate"], 3.0);
  EXPECT_NEAR(larger["Exterior:Lights"]["Lamp"]["design_level"], 100.0 * length * length, 1e-9);
}

TEST(EplusPlans, WantEveryKindBeforeAnyTwice) {
  std::map<std::string, int> first;
  for (const EplusCasePlan& plan : plans_of("sealed", 2)) {
    if (plan.block == Block::single) ++first[plan.candidates.front()];
    const std::set<std::string> kinds(plan.candidates.begin(), plan.candidates.end());
    EXPECT_EQ(kinds.size(), plan.candidates.size()) << "no candidate twice";
  }
  EXPECT_GE(first.size(), 30u);
  std::set<int> times;
  for (const auto& [kind, count] : first) times.insert(count);
  EXPECT_LE(*times.rbegin() - *times.begin(), 1);
}

TEST(EplusPlans, DependOnNameAndSeed) {
  const auto one = plans_of("development", 5);
  const auto again = plans_of("development", 5);
  std::set<std::uint64_t> seeds;
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].building.seed, again[i].building.seed);
    EXPECT_EQ(one[i].candidates, again[i].candidates);
    seeds.insert(one[i].building.seed);
  }
  for (const char* name : {"development", "sealed", "learning", "smoke"}) {
    for (const EplusCasePlan& plan : plans_of(name, 6)) seeds.insert(plan.building.seed);
  }
  EXPECT_EQ(seeds.size(), one.size() + plans_of("development", 6).size() +
                              plans_of("sealed", 6).size() + plans_of("learning", 6).size() +
                              plans_of("smoke", 6).size())
      << "no two cases share a seed";
}

/// A small building of each kind of effect's world, made by EnergyPlus once for all tests.
class InEnergyPlus : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto program = recald::testing::installed_energyplus(RECALD_ENERGYPLUS_ENVIRONMENT);
    if (program.empty()) return;
    ::setenv("RECALD_ENERGYPLUS", program.c_str(), 1);
    engine_ = new Engine(*Engine::find());
    folder_ = new TemporaryFolder;
    made_ = new Result<SimulatedBuilding>(
        SimulatedBuilding::make(plan(), *engine_, *folder_ / "building"));
  }
  static void TearDownTestSuite() {
    delete made_;
    delete folder_;
    delete engine_;
  }
  void SetUp() override {
    if (made_ == nullptr) GTEST_SKIP() << "EnergyPlus is not installed";
    ASSERT_TRUE(made_->has_value()) << made_->error().message;
  }

  static EplusPlan plan() {
    simulators::Brief brief = simulators::typical_brief(simulators::Use::office);
    brief.storeys = 1;
    brief.length_m = 30.0;
    brief.width_m = 14.0;
    return {.id = "test",
            .seed = 11,
            .building = {simulators::draw_up(brief), simulators::energyplus::Shape::bar,
                         simulators::energyplus::AirSystem::packaged_vav},
            .first_year = 2021,
            .years = 1};
  }
  static const SimulatedBuilding& building() { return **made_; }
  /// What an effect adds to a meter, kW by quarter hour of standard time.
  static std::vector<double> added_kW(const char* effect, double strength, std::size_t meter) {
    const auto loads = building().with({hidden_change(effect), strength, {}, {}});
    EXPECT_TRUE(loads.has_value()) << loads.error().message;
    std::vector<double> added = loads.has_value() ? (*loads)[meter] : std::vector<double>(35040);
    for (std::size_t i = 0; i < added.size(); ++i) added[i] -= building().twin()[meter][i];
    return added;
  }

  static Engine* engine_;
  static TemporaryFolder* folder_;
  static Result<SimulatedBuilding>* made_;
};
Engine* InEnergyPlus::engine_ = nullptr;
TemporaryFolder* InEnergyPlus::folder_ = nullptr;
Result<SimulatedBuilding>* InEnergyPlus::made_ = nullptr;

TEST_F(InEnergyPlus, HasTheMetersOfItsPlant) {
  std::set<std::string> ids;
  for (const CaseMeter& meter : building().meters()) ids.insert(meter.sum.id);
  EXPECT_EQ(ids, (std::set<std::string>{"electricity", "heating"}));
  for (const std::vector<double>& load : building().twin()) {
    ASSERT_EQ(load.size(), 365u * 96u);
    EXPECT_GT(*std::ranges::max_element(load), 0.0);
  }
}

TEST_F(InEnergyPlus, LampsOutsideBurnAtNightAndHeatNothing) {
  const std::vector<double> lamps = added_kW("exterior_lighting", 2.0, 0);
  constexpr double kLamps_kW = 2.0e-3 * 30.0 * 14.0;
  for (std::size_t day = 0; day < 365; ++day) {
    EXPECT_NEAR(lamps[day * 96 + 48], 0.0, 1e-6) << "at noon of day " << day;
    EXPECT_NEAR(lamps[day * 96 + 4], kLamps_kW, 0.01) << "at one in the night of day " << day;
  }
  const std::vector<double> heat = added_kW("exterior_lighting", 2.0, 1);
  for (const double kW : heat) ASSERT_NEAR(kW, 0.0, 1e-6);
}

TEST_F(InEnergyPlus, WeekendsThatRunShowOnWeekends) {
  const std::vector<double> added = added_kW("weekend_operation", 2.0, 0);
  double weekend_kWh = 0.0;
  double later_kWh = 0.0;  // On Thursdays and Fridays, when walls have forgotten the weekend.
  for (std::size_t i = 0; i < added.size(); ++i) {
    const std::size_t weekday = (i / 96 + 4) % 7;  // 2021 began on a Friday; Monday is 0.
    if (weekday >= 5) weekend_kWh += 0.25 * added[i];
    if (weekday == 3 || weekday == 4) later_kWh += 0.25 * added[i];
  }
  EXPECT_GT(weekend_kWh, 500.0);
  EXPECT_LT(std::abs(later_kWh), 0.1 * weekend_kWh);
}

TEST_F(InEnergyPlus, NoStrengthIsNoEffect) {
  const std::vector<double> none = added_kW("stack_infiltration", 0.0, 1);
  for (const double kW : none) ASSERT_NEAR(kW, 0.0, 0.02);
}

TEST_F(InEnergyPlus, WhatBeginsOnADayChangesNothingBefore) {
  const metering::Day july{std::chrono::year{2021} / 7 / 1};
  const auto loads = building().with({hidden_change("server_room"), 5.0, july, {}});
  ASSERT_TRUE(loads.has_value()) << loads.error().message;
  constexpr std::size_t kJuly = 181 * 96 - 4;  // In summer the day begins an hour earlier.
  for (std::size_t i = 0; i < kJuly; ++i) ASSERT_EQ((*loads)[0][i], building().twin()[0][i]);
  EXPECT_GT((*loads)[0][kJuly + 10], building().twin()[0][kJuly + 10] + 1.5);
}

TEST_F(InEnergyPlus, TheSiteFileTellsWhatDrawingsTell) {
  const std::string site = building().site_text(building().plates());
  EXPECT_THAT(site, HasSubstr("floor_area_m2 = 420"));
  EXPECT_THAT(site, HasSubstr("storeys = 1"));
  EXPECT_THAT(site, HasSubstr("cooling_occupied_C = 24.0"));
  EXPECT_THAT(site, HasSubstr("heating_unoccupied_C = 17.0"));
  EXPECT_THAT(site, HasSubstr("name = \"south windows\""));
  EXPECT_THAT(site, HasSubstr("chiller_cop"));
  EXPECT_THAT(site, Not(HasSubstr("idle_kW"))) << "nothing is pumped";
  EXPECT_THAT(site, HasSubstr("reheat_boxes = true"));
  EXPECT_THAT(site, HasSubstr("outdoor_air_unoccupied_fraction = 0.0"));
  EXPECT_THAT(site, Not(HasSubstr("saturday_occupied")));
  EXPECT_THAT(site, HasSubstr("calibration = { from = \"2021-01\", to = \"2021-08\" }"));
  EXPECT_THAT(site, HasSubstr("validation = { from = \"2021-09\", to = \"2021-12\" }"));
}

TEST_F(InEnergyPlus, ACaseHidesWhatTheBuildingCanHave) {
  EplusCasePlan wanted{.building = plan(),
                       .family = Family::learning,
                       .block = Block::single,
                       .care = simulators::MeterCare::gaps,
                       .wanted = {0.03, 0.1},
                       .candidates = {"chiller_part_load", "server_room"}};
  wanted.building.id = "case";
  const std::filesystem::path out = *folder_ / "once";
  const CaseFolders folders{out / "cases", out / "answers", out / "twins"};
  for (const auto& each : {folders.cases, folders.answers}) {
    std::filesystem::create_directories(each);
  }
  const auto made = make_eplus_case(wanted, *engine_, out / "scratch", folders);
  ASSERT_TRUE(made.has_value()) << made.error().message;
  EXPECT_FALSE(std::filesystem::exists(out / "scratch"));
  EXPECT_EQ(read_text(out / "cases/case/site.toml"), read_text(out / "twins/case/site.toml"));
  EXPECT_NE(read_text(out / "cases/case/readings.csv"), read_text(out / "twins/case/readings.csv"));
  EXPECT_THAT(read_text(out / "twins/case/footprint.csv"),
              HasSubstr("timestamp,meter,value,unit\n"));
  const nlohmann::json answer = written_answers(out / "answers").at("case");
  ASSERT_EQ(answer["effects"].size(), 1u);
  const nlohmann::json& hidden = answer["effects"][0];
  EXPECT_EQ(hidden["effect"], "server_room") << "there is no chiller";
  const double setpoint = answer["true_parameters"]["cooling_setpoint"];
  EXPECT_NEAR(setpoint, 24.0, 1.2);
  EXPECT_NE(setpoint, 24.0);
  EXPECT_GT(answer["prior_sd"]["outdoor_airflow"].get<double>(), 0.0);
  EXPECT_GE(hidden["moved_share"]["electricity"].get<double>(), 0.03);
  EXPECT_LT(hidden["moved_share"]["electricity"].get<double>(), 0.1);
}

}  // namespace
}  // namespace recald::blind::eplus_case_test
