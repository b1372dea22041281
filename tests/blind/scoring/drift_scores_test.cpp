#include "tests/blind/scoring/drift_scores.hpp"

#include <gtest/gtest.h>

#include "tests/blind/scoring/made_up.hpp"
#include "tests/blind/scoring/scores.hpp"

namespace recald::blind {
namespace {

using made_up::said;

CaseResult followed(const std::string& case_id, std::vector<DriftCause> alarms) {
  CaseResult result = said(case_id, Outcome::none, {}, std::string(kDrift));
  result.drift = Drift{.from = "2021-01", .to = "2022-12", .alarms = std::move(alarms)};
  return result;
}

HiddenEffect dated(const std::string& id, const std::string& effect_class, double share,
                   const std::string& from = "2022-03-10") {
  HiddenEffect hidden = made_up::moving(id, share);
  hidden.effect_class = effect_class;
  hidden.from = from;
  return hidden;
}

void add(made_up::Population& population, Answer answer, std::vector<DriftCause> alarms) {
  const std::string id = answer.case_id;
  population.add(std::move(answer), said(id, Outcome::none));
  population.add(followed(id, std::move(alarms)));
}

DriftScores drift_scores_of(const made_up::Population& population) {
  return drift_scores(population.cases(), drifts_of(population.results()));
}

TEST(DriftScores, CountWhatBeginsInAWatchedMonth) {
  made_up::Population population;
  add(population, made_up::single("a", dated("scale_fault", "meters", 0.2)),
      {{"2022-05", "meter", "electricity_daily_kWh", 0.9}, {"2022-04", "use", "", 0.5}});
  add(population, made_up::single("b", dated("outdoor_air_amount", "outdoor_air", 0.02)), {});
  add(population, made_up::single("c", dated("server_room", "electrical", 0.05)),
      {{"2022-01", "use", "electricity use", 0.9}, {"2022-03", "use", "electricity use", 0.95}});
  add(population, made_up::single("d", dated("server_room", "electrical", 0.2, "2020-03-10")),
      {{"2022-03", "meter", "gas", 0.9}});
  add(population, made_up::single("e", made_up::moving("A", 0.2)), {});
  const DriftScores scores = drift_scores_of(population);
  EXPECT_EQ(scores.found->hits, 2);
  EXPECT_EQ(scores.found->cases, 3) << "one began before, one is always there";
  EXPECT_EQ(scores.found_large->cases, 2);
  EXPECT_DOUBLE_EQ(scores.delay_months->value, 0.5) << "of 1 and 0";
  EXPECT_EQ(scores.early->hits, 1);
  EXPECT_EQ(scores.cause_right->hits, 1) << "the first alarm counts, not the best";
  EXPECT_EQ(scores.side_right->hits, 1);
  EXPECT_EQ(scores.sure_right->hits, 1);
  EXPECT_EQ(scores.sure_right->cases, 1);
  EXPECT_FALSE(scores.false_alarms);
}

TEST(DriftScores, AnyAlarmWhereNothingIsHiddenIsFalse) {
  made_up::Population population;
  add(population, made_up::nothing_hidden("a"), {{"2022-03", "nothing", "", 0.0}});
  add(population, made_up::nothing_hidden("b"), {});
  population.add(made_up::nothing_hidden("c"), said("c", Outcome::none));  // was not followed
  const DriftScores scores = drift_scores_of(population);
  EXPECT_EQ(scores.false_alarms->hits, 1);
  EXPECT_EQ(scores.false_alarms->cases, 2);
  EXPECT_FALSE(scores.found);
}

TEST(DriftScores, ACauseIsRightIfItIsWhatTheEffectWouldBestBeCalled) {
  const HiddenEffect meter = dated("scale_fault", "meters", 0.2);
  EXPECT_TRUE(is_right_cause(meter, {"", "meter", "electricity_daily_kWh", 1.0}));
  EXPECT_FALSE(is_right_cause(meter, {"", "meter", "steam_daily_kWh", 1.0}));
  EXPECT_TRUE(is_right_side(meter, {"", "meter", "steam_daily_kWh", 1.0}));
  EXPECT_FALSE(is_right_side(meter, {"", "unknown", "electricity_daily_kWh", 1.0}));
  const HiddenEffect air = dated("outdoor_air_amount", "outdoor_air", 0.2);
  EXPECT_TRUE(is_right_cause(air, {"", "parameter", "outdoor_airflow", 1.0}));
  EXPECT_FALSE(is_right_cause(air, {"", "parameter", "heating_setpoint", 1.0}));
  EXPECT_FALSE(is_right_cause(air, {"", "unknown", "", 1.0})) << "a parameter says it";
  EXPECT_TRUE(is_right_cause(air, {"", "effect", "outdoor_air_amount", 1.0}));
  EXPECT_TRUE(is_right_cause(air, {"", "effect", "demand_ventilation", 1.0})) << "the same air";
  EXPECT_FALSE(is_right_cause(air, {"", "effect", "server_room", 1.0}));
  EXPECT_TRUE(is_right_side(air, {"", "unknown", "", 1.0}));
  const HiddenEffect server = dated("server_room", "electrical", 0.2);
  EXPECT_TRUE(is_right_cause(server, {"", "use", "electricity use", 1.0}));
  EXPECT_FALSE(is_right_cause(server, {"", "unknown", "", 1.0}));
  const HiddenEffect pool = dated("swimming_pool", "outside_catalogue", 0.2);
  EXPECT_TRUE(is_right_cause(pool, {"", "unknown", "", 1.0}));
  EXPECT_FALSE(is_right_cause(pool, {"", "nothing", "", 1.0}));
  EXPECT_FALSE(is_right_side(pool, {"", "nothing", "", 1.0}));
}

TEST(DriftScores, AreNoMethodThatNamesAnything) {
  made_up::Population population;
  add(population, made_up::nothing_hidden("a"), {});
  const Scores scores = compute_scores(population.key(), population.results(), {}, {});
  EXPECT_EQ(scores.methods.size(), 1u);
  EXPECT_TRUE(missing_cases(population.key(), population.results(), "recald").empty());
}

}  // namespace
}  // namespace recald::blind
