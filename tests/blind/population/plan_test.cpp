#include "tests/blind/population/plan.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace recald::blind {
namespace {

using simulators::EffectClass;

std::vector<CasePlan> plans_of(const char* name, std::uint64_t seed) {
  return plan_population(*population_kind(name), seed);
}

TEST(Plan, HasTheBlocksOfTheProtocol) {
  const auto plans = plans_of("sealed", 1);
  ASSERT_EQ(plans.size(), 200u);
  std::map<Block, int> count;
  for (const CasePlan& plan : plans) ++count[plan.block];
  EXPECT_EQ(count[Block::no_effect], 60);
  EXPECT_EQ(count[Block::single], 100);
  EXPECT_EQ(count[Block::out_of_catalogue], 20);
  EXPECT_EQ(count[Block::pair], 20);
  EXPECT_EQ(plans_of("smoke", 1).size(), 12u);
  EXPECT_EQ(population_kind("secret").error().message,
            "unknown population secret; there are smoke, training, sealed and plain");
}

TEST(Plan, AsksForTheDetectabilitiesOfTheProtocol) {
  const auto singles_of = [](const char* name) {
    std::map<double, int> count;
    for (const CasePlan& plan : plans_of(name, 2)) {
      if (plan.block == Block::single) ++count[plan.wanted[0].target];
    }
    return count;
  };
  EXPECT_EQ(singles_of("sealed"), (std::map<double, int>{{8.0, 60}, {16.0, 40}}));
  EXPECT_EQ(singles_of("training"),
            (std::map<double, int>{{2.0, 25}, {4.0, 25}, {8.0, 25}, {16.0, 25}}));
  for (const CasePlan& plan : plans_of("sealed", 2)) {
    if (plan.block != Block::pair) continue;
    // Found within 5 %, neither of two may fall below 8.
    for (const Wanted& wanted : plan.wanted) EXPECT_GE(0.95 * wanted.target, 8.0);
  }
}

TEST(Plan, HidesWhatItsBlockSays) {
  for (const CasePlan& plan : plans_of("training", 3)) {
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

// A hundred singles over forty kinds: each comes twice or thrice, drawn without replacement, then
// again.
TEST(Plan, DealsEveryKindBeforeAnyComesTwice) {
  std::map<std::string_view, int> dealt;
  for (const CasePlan& plan : plans_of("sealed", 9)) {
    if (plan.block == Block::single) ++dealt[plan.wanted[0].candidates[0].kind->id];
  }
  EXPECT_EQ(dealt.size(), 40u);
  for (const auto& [id, times] : dealt) {
    EXPECT_GE(times, 2) << id;
    EXPECT_LE(times, 3) << id;
  }
}

TEST(Plan, TrainingAndSealedShareNoBuildingWeatherOrSeed) {
  std::set<std::uint64_t> seeds;
  std::set<std::pair<double, double>> buildings;  // what the engineer remembers is continuous
  std::size_t cases = 0;
  for (const char* name : {"smoke", "training", "sealed"}) {
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
  const auto one = plans_of("training", 11);
  const auto two = plans_of("training", 11);
  const auto other = plans_of("training", 12);
  int alike = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].seed, two[i].seed);
    EXPECT_EQ(one[i].scenario.drawings.description, two[i].scenario.drawings.description);
    EXPECT_EQ(one[i].block, two[i].block);
    alike += one[i].block == other[i].block ? 1 : 0;
    EXPECT_NE(one[i].seed, other[i].seed);
  }
  EXPECT_LT(alike, 150);
}

TEST(Plan, SiteFilesAreWrongButPlausible) {
  double worst = 0.0;
  for (const CasePlan& plan : plans_of("training", 5)) {
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
    for (const char* name : {"smoke", "training", "sealed"}) count(plans_of(name, seed));
    count(plan_plain(kToLearn, 200, seed));
    count(plan_plain(kToJudge, 200, seed));
    count(plan_plain({Use::shop}, 200, seed));
  }
  EXPECT_EQ(seeds.size(), cases);
}

}  // namespace
}  // namespace recald::blind
