#include "tests/blind/population/plan.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace recald::blind::plan_test {
namespace {

using simulators::EffectClass;

std::vector<CasePlan> plans_of(const char* name, std::uint64_t seed) {
  return plan_population(*population_kind("own", name), seed);
}

TEST(Plan, HasTheSizesOfTheProtocol) {
  const auto plans = plans_of("sealed", 1);
  std::map<Block, int> count;
  std::map<double, int> bins;
  for (const CasePlan& plan : plans) {
    ++count[plan.block];
    if (plan.block == Block::single) ++bins[plan.wanted[0].share.least];
  }
  EXPECT_GE(count[Block::no_effect], 100);
  EXPECT_GE(bins[0.1], 60);
  EXPECT_GE(bins[0.03], 60);
  EXPECT_GE(bins[0.005], 40);
  EXPECT_EQ(plans_of("smoke", 1).size(), 12u);
  EXPECT_GE(plans_of("learning", 1).size(), 1500u);
  EXPECT_EQ(population_kind("own", "secret").error().message,
            "unknown population secret; there are smoke, development, learning, sealed and, of our "
            "own world, plain");
}

TEST(Plan, SealedBuildingsAreOfUsesThatNothingWasLearntOn) {
  const auto uses_in = [](const char* name) {
    std::set<simulators::Use> uses;
    for (const CasePlan& plan : plans_of(name, 4)) uses.insert(plan.scenario.drawings.use);
    return uses;
  };
  const auto set_of = [](Family family) {
    const auto uses = uses_of(family);
    return std::set<simulators::Use>(uses.begin(), uses.end());
  };
  EXPECT_EQ(uses_in("sealed"), set_of(Family::judging));
  EXPECT_EQ(uses_in("development"), set_of(Family::learning));
  for (const simulators::Use use : set_of(Family::judging)) {
    EXPECT_FALSE(set_of(Family::learning).contains(use));
  }
}

// Whether and what a case hides must not show in what is built: the same building comes whatever
// the slot is.
TEST(Plan, WhatIsHiddenDoesNotShowInTheBuilding) {
  PopulationKind nothing = *population_kind("own", "development");
  nothing.no_effect += 160;
  nothing.singles.clear();
  const auto with = plans_of("development", 8);
  const auto without = plan_population(nothing, 8);
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_EQ(with[i].seed, without[i].seed);
    EXPECT_EQ(with[i].scenario.drawings.description, without[i].scenario.drawings.description);
    EXPECT_EQ(with[i].as_believed.wall_u_W_m2K, without[i].as_believed.wall_u_W_m2K);
  }
}

TEST(Plan, AQuarterBeginsInTheForecastYear) {
  int hidden = 0;
  int late = 0;
  for (const CasePlan& plan : plans_of("learning", 2)) {
    if (plan.wanted.empty()) continue;
    ++hidden;
    const auto& from = plan.wanted[0].candidates[0].from;
    const int last = plan.scenario.period.start_year + plan.scenario.period.years - 1;
    late += from && static_cast<int>(from->year()) == last ? 1 : 0;
  }
  EXPECT_NEAR(late, 0.25 * hidden, 0.05 * hidden);
}

TEST(Plan, HidesWhatItsBlockSays) {
  for (const CasePlan& plan : plans_of("development", 3)) {
    SCOPED_TRACE(plan.id);
    const std::size_t hidden = plan.wanted.size();
    switch (plan.block) {
      case Block::no_effect:
        EXPECT_EQ(hidden, 0u);
        break;
      case Block::single:
        EXPECT_EQ(hidden, 1u);
        break;
      case Block::pair:
        EXPECT_EQ(hidden, 2u);
        break;
      case Block::out_of_catalogue:
        EXPECT_EQ(hidden + plan.scenario.decoys.size(), 1u);
        break;
    }
    for (const Wanted& wanted : plan.wanted) {
      ASSERT_FALSE(wanted.candidates.empty());
      for (const auto& candidate : wanted.candidates) {
        EXPECT_EQ(candidate.kind->group == EffectClass::outside_catalogue,
                  plan.block == Block::out_of_catalogue);
        simulators::Scenario alone = plan.scenario;
        alone.effects = {candidate};
        const auto possible = simulators::check_effects(alone);
        EXPECT_TRUE(possible.has_value()) << possible.error().message;
      }
    }
  }
}

// Kinds that few buildings can have wait for one; the others come in turn.
TEST(Plan, DealsEveryKindBeforeAnyComesOften) {
  std::map<std::string_view, int> dealt;
  int singles = 0;
  for (const CasePlan& plan : plans_of("development", 9)) {
    if (plan.block != Block::single) continue;
    ++dealt[plan.wanted[0].candidates[0].kind->id];
    ++singles;
  }
  EXPECT_GE(dealt.size(), 38u);
  for (const auto& [id, times] : dealt) EXPECT_LE(times, 3 * singles / 40) << id;
}

TEST(Plan, DevelopmentAndSealedShareNoBuildingWeatherOrSeed) {
  std::set<std::uint64_t> seeds;
  std::set<std::pair<double, double>> buildings;  // what the engineer remembers is continuous
  std::size_t cases = 0;
  for (const char* name : {"smoke", "development", "sealed"}) {
    for (const CasePlan& plan : plans_of(name, 7)) {
      seeds.insert(plan.seed);
      const auto& drawings = plan.scenario.drawings;
      buildings.insert(
          {drawings.length_m * 1000.0 + drawings.width_m + 1e-3 * drawings.window_share,
           drawings.chilled_water_design_kW + 1e-6 * drawings.heating_design_kW});
      ++cases;
    }
  }
  EXPECT_EQ(seeds.size(), cases);
  EXPECT_EQ(buildings.size(), cases);
}

TEST(Plan, SameSeedSamePlansAndOtherSeedOthers) {
  const auto one = plans_of("development", 11);
  const auto two = plans_of("development", 11);
  const auto other = plans_of("development", 12);
  int alike = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].seed, two[i].seed);
    EXPECT_EQ(one[i].scenario.drawings.description, two[i].scenario.drawings.description);
    EXPECT_EQ(one[i].block, two[i].block);
    alike += one[i].block == other[i].block ? 1 : 0;
    EXPECT_NE(one[i].seed, other[i].seed);
  }
  EXPECT_LT(alike, 0.6 * static_cast<double>(one.size()));
}

TEST(Plan, SiteFilesAreWrongButPlausible) {
  double worst = 0.0;
  for (const CasePlan& plan : plans_of("development", 5)) {
    const auto& built = plan.scenario.drawings;
    const auto& believed = plan.as_believed;
    EXPECT_EQ(believed.floor_area_m2(), built.floor_area_m2());
    EXPECT_EQ(believed.heating, built.heating);
    const double off = believed.wall_u_W_m2K / built.wall_u_W_m2K - 1.0;
    worst = std::max(worst, std::abs(off));
    EXPECT_LT(std::abs(off), 0.35);
    EXPECT_LT(believed.heating_efficiency, 1.0);
  }
  EXPECT_GT(worst, 0.1);
}

using simulators::Use;

const std::vector<Use> kToLearn{Use::laboratory, Use::office, Use::school, Use::hotel,
                                Use::warehouse};
const std::vector<Use> kToJudge{Use::shop, Use::clinic, Use::restaurant, Use::gym};

TEST(PlainPlan, TakesUsesByNameInAnyOrderAndRefusesOthers) {
  EXPECT_EQ(*uses_named({"shop", "office", "shop"}), (std::vector<Use>{Use::office, Use::shop}));
  EXPECT_EQ(uses_named({"office", "palace"}).error().message,
            "unknown use palace; there are laboratory, office, school, shop, hotel, clinic, "
            "warehouse, restaurant, gym");
  EXPECT_EQ(uses_named({}).error().code, ErrorCode::not_enough_data);
}

TEST(PlainPlan, HidesNothingAndTakesTheUsesInTurn) {
  const auto plans = plan_plain(kToJudge, 60, 5);
  ASSERT_EQ(plans.size(), 60u);
  for (std::size_t i = 0; i < plans.size(); ++i) {
    SCOPED_TRACE(plans[i].id);
    const auto& scenario = plans[i].scenario;
    EXPECT_EQ(scenario.drawings.use, kToJudge[i % 4]);
    EXPECT_EQ(plans[i].block, Block::no_effect);
    EXPECT_TRUE(plans[i].wanted.empty());
    EXPECT_TRUE(scenario.effects.empty());
    EXPECT_TRUE(scenario.decoys.empty());
    EXPECT_EQ(scenario.care, simulators::MeterCare::usual);
    EXPECT_EQ(scenario.period.years, 3);
    EXPECT_FALSE(*scenario.drawings.saturday_operation);
    EXPECT_FALSE(scenario.drawings.attendance_follows_season);
  }
}

// Of sixty each climate and plant comes, sizes differ by a factor, and every age stands.
TEST(PlainPlan, DrawsClimatesPlantsSizesAndAges) {
  std::set<simulators::ClimateKind> climates;
  std::set<simulators::CoolingPlant> coolings;
  std::set<simulators::HeatingPlant> heatings;
  std::set<double> walls_in_mixed;
  double least_m2 = 1e9;
  double most_m2 = 0.0;
  for (const CasePlan& plan : plan_plain(kToLearn, 100, 6)) {
    const auto& drawings = plan.scenario.drawings;
    climates.insert(drawings.climate);
    coolings.insert(drawings.cooling);
    heatings.insert(drawings.heating);
    if (drawings.climate == simulators::ClimateKind::mixed) {
      walls_in_mixed.insert(drawings.wall_u_W_m2K);
    }
    least_m2 = std::min(least_m2, drawings.floor_area_m2());
    most_m2 = std::max(most_m2, drawings.floor_area_m2());
  }
  EXPECT_EQ(climates.size(), 5u);
  EXPECT_EQ(coolings.size(), 3u);
  EXPECT_EQ(heatings.size(), 4u);
  EXPECT_EQ(walls_in_mixed.size(), 3u);
  EXPECT_GT(most_m2, 8.0 * least_m2);
}

TEST(PlainPlan, SameSeedSamePlansHoweverManyFollow) {
  const auto few = plan_plain(kToJudge, 9, 11);
  const auto many = plan_plain(kToJudge, 30, 11);
  const auto other = plan_plain(kToJudge, 9, 12);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i].seed, many[i].seed);
    EXPECT_EQ(few[i].scenario.drawings.description, many[i].scenario.drawings.description);
    EXPECT_EQ(few[i].as_believed.wall_u_W_m2K, many[i].as_believed.wall_u_W_m2K);
    EXPECT_NE(few[i].seed, other[i].seed);
  }
}

// What sizes are learnt on and what they are judged by share no seed, under the same number either,
// and none with any other population.
TEST(PlainPlan, SetsOfUsesShareNoSeed) {
  std::set<std::uint64_t> seeds;
  std::size_t cases = 0;
  const auto count = [&](const std::vector<CasePlan>& plans) {
    for (const CasePlan& plan : plans) seeds.insert(plan.seed);
    cases += plans.size();
  };
  for (const std::uint64_t seed : {7, 8}) {
    for (const char* name : {"smoke", "development", "sealed"}) count(plans_of(name, seed));
    count(plan_plain(kToLearn, 200, seed));
    count(plan_plain(kToJudge, 200, seed));
    count(plan_plain({Use::shop}, 200, seed));
  }
  EXPECT_EQ(seeds.size(), cases);
}

}  // namespace
}  // namespace recald::blind::plan_test
