#include "tests/blind/scoring/gap_scores.hpp"

#include <gtest/gtest.h>

#include "tests/blind/scoring/cost_scores.hpp"
#include "tests/blind/scoring/made_up.hpp"

namespace recald::blind {
namespace {

using made_up::effect;
using made_up::named;
using made_up::said;

/// Steam is the meter most affected by `effect`; electricity never changes.
FitOfMeter fit(double steam_cvrmse, double steam_log_score) {
  return {{"steam", {.log_score = steam_log_score, .cvrmse = steam_cvrmse}},
          {"electricity", {.log_score = -1.0, .cvrmse = 0.02}}};
}

CaseResult with_gap(CaseResult result, Gap gap) {
  result.gap = std::move(gap);
  return result;
}

GapReduction reduction_of(const CaseResult& result, const OracleGaps& oracles = {}) {
  const Answer answer = made_up::single("s", effect("A"));
  return gap_reduction({&answer, &result, judge(answer, result, {})}, oracles);
}

// CV(RMSE): (0.20 - 0.11) / (0.20 - 0.08) = 0.75. Log scores, electricity cancelling:
// E = 3, 2.2, 2: (3 - 2.2) / (3 - 2) = 0.8.
TEST(GapScores, ReductionByHand) {
  const GapReduction r = reduction_of(
      with_gap(named("s", {"A"}),
               {.before = fit(0.20, -3.0), .after = fit(0.11, -2.2), .oracle = fit(0.08, -2.0)}));
  EXPECT_NEAR(r.cvrmse.value(), 0.75, 1e-12);
  EXPECT_NEAR(r.log_score.value(), 0.8, 1e-12);
}

TEST(GapScores, TheOracleMayComeFromItsOwnLine) {
  const CaseResult result =
      with_gap(named("s", {"A"}), {.before = fit(0.20, -3.0), .after = fit(0.11, -2.2)});
  EXPECT_FALSE(reduction_of(result).cvrmse);
  const std::vector lines{with_gap(named("s", {"A"}, {}, "oracle"),
                                   {.before = fit(0.20, -3.0), .after = fit(0.08, -2.0)})};
  EXPECT_NEAR(reduction_of(result, oracle_gaps(lines)).cvrmse.value(), 0.75, 1e-12);
}

TEST(GapScores, NothingAddedClosesNothing) {
  const std::vector lines{with_gap(named("s", {"A"}, {}, "oracle"),
                                   {.before = fit(0.20, -3.0), .after = fit(0.08, -2.0)})};
  EXPECT_EQ(reduction_of(said("s", Outcome::none), oracle_gaps(lines)).cvrmse, 0.0);
  EXPECT_EQ(reduction_of(said("s", Outcome::none), oracle_gaps(lines)).log_score, 0.0);
  // An addition without figures is not known to close nothing.
  EXPECT_FALSE(reduction_of(named("s", {"A"}), oracle_gaps(lines)).cvrmse);
}

// The true effect may fail to help on the held months; there is then no gap to close.
TEST(GapScores, WhereTheOracleClosesNothingThereIsNoReduction) {
  const GapReduction r = reduction_of(
      with_gap(named("s", {"A"}),
               {.before = fit(0.20, -3.0), .after = fit(0.11, -2.2), .oracle = fit(0.20, -2.9)}));
  EXPECT_FALSE(r.cvrmse);
  EXPECT_NEAR(r.log_score.value(), 8.0, 1e-9);  // 0.8 of 0.1: better than the truth, not clipped
}

TEST(GapScores, AGapWithoutTheMeterHasNoReduction) {
  FitOfMeter other{{"water", {.log_score = -1.0, .cvrmse = 0.1}}};
  EXPECT_FALSE(
      reduction_of(with_gap(named("s", {"A"}), {.before = other, .after = other, .oracle = other}))
          .cvrmse);
}

/// CV(RMSE) from 0.2 towards the oracle's 0.1 by `share`.
Gap closing(double share) {
  return {.before = fit(0.2, -3.0),
          .after = fit(0.2 - 0.1 * share, -3.0 + share),
          .oracle = fit(0.1, -2.0)};
}

// Named and large: 0.2, 0.6, 0.9; the median is 0.6. Over all with an effect also 0 (none
// said) and 0.4 (it moves 2 %): median of 0, 0.2, 0.4, 0.6, 0.9 is 0.4. A false name does not
// enter.
TEST(GapScores, MediansByHand) {
  made_up::Population population;
  HiddenEffect small = effect("A");
  small.moved_share = {{"electricity", 0.0}, {"steam", 0.02}};
  population.add(made_up::single("a", effect("A")), with_gap(named("a", {"A"}), closing(0.2)));
  population.add(made_up::single("b", effect("A")), with_gap(named("b", {"A"}), closing(0.6)));
  population.add(made_up::pair("c", effect("A"), effect("B")),
                 with_gap(named("c", {"A"}), closing(0.9)));
  population.add(made_up::single("d", effect("A")), with_gap(said("d", Outcome::none), closing(0)));
  population.add(made_up::single("e", small), with_gap(named("e", {"A"}), closing(0.4)));
  population.add(made_up::nothing_hidden("f"), with_gap(named("f", {"A"}), closing(1.0)));
  population.add(made_up::single("g", effect("A")), named("g", {"A"}));
  const GapScores scores = gap_scores(population.cases(), {});
  EXPECT_EQ(scores.large_named, 4);  // a, b, c, g
  EXPECT_EQ(scores.cvrmse->cases, 3);
  EXPECT_NEAR(scores.cvrmse->value, 0.6, 1e-12);
  EXPECT_NEAR(scores.log_score->value, 0.6, 1e-12);
  EXPECT_EQ(scores.cvrmse_all->cases, 5);
  EXPECT_NEAR(scores.cvrmse_all->value, 0.4, 1e-12);
}

// Worse by 0.3 with se 0.1: harm. By 0.2 with se 0.1: exactly two, not more. Better: no.
TEST(GapScores, HarmIsMoreThanTwoStandardErrors) {
  made_up::Population population;
  const auto add = [&](const char* id, std::map<std::string, LogScoreChange> changes) {
    CaseResult result = named(id, {"A"});
    result.other_meters = std::move(changes);
    population.add(made_up::single(id, effect("A")), result);
  };
  add("a", {{"x", {.mean = 0.5, .se = 0.1}}, {"y", {.mean = -0.3, .se = 0.1}}});
  add("b", {{"x", {.mean = -0.2, .se = 0.1}}});
  add("c", {{"x", {.mean = 0.3, .se = 0.1}}});
  add("d", {});
  const GapScores scores = gap_scores(population.cases(), {});
  EXPECT_EQ(*scores.harm->hits, 1);
  EXPECT_EQ(scores.harm->cases, 3);
  EXPECT_EQ(scores.additions_without_harm_figures, 1);
}

// Truth 24 degC (sd 2) and 1 (sd 0.5). Before: |27 - 24| / 2 = 1.5 and |1.25 - 1| / 0.5 = 0.5,
// mean 1.0. After: 0.3 and 0.1, mean 0.2. A parameter without a truth does not count.
TEST(GapScores, BiasByHand) {
  made_up::Population population;
  CaseResult result = named("a", {"A"});
  result.parameters_before = {{"cooling_setpoint_C", {.mean = 27.0}},
                              {"occupancy", {.mean = 1.25}}};
  result.parameters_after = {{"cooling_setpoint_C", {.mean = 24.6}},
                             {"occupancy", {.mean = 0.95}},
                             {"zone_mass", {.mean = 7.0}}};
  population.add(made_up::single("a", effect("A")), result);
  // Not named: nothing was done about the bias, so it says nothing about naming.
  CaseResult idle = said("b", Outcome::none);
  idle.parameters_before = idle.parameters_after = result.parameters_before;
  population.add(made_up::single("b", effect("A")), idle);
  const GapScores scores = gap_scores(population.cases(), {});
  EXPECT_EQ(scores.bias.before->cases, 1);
  EXPECT_NEAR(scores.bias.before->value, 1.0, 1e-12);
  EXPECT_NEAR(scores.bias.after->value, 0.2, 1e-12);
  EXPECT_NEAR(scores.bias.ratio->value, 0.2, 1e-12);
  EXPECT_EQ(scores.parameters_without_truth, std::vector<std::string>{"zone_mass"});
}

// The strength is 3 h.
TEST(GapScores, CoverageOfTheEffectByHand) {
  made_up::Population population;
  const auto add = [&](const char* id, const char* name, EffectInterval interval) {
    CaseResult result = named(id, {name});
    result.effect_parameter = std::move(interval);
    population.add(made_up::single(id, effect("A")), result);
  };
  add("a", "A", {.q05 = 2.0, .q95 = 3.5});
  add("b", "A", {.q05 = 3.0, .q95 = 3.0, .unit = "h"});
  add("c", "A", {.q05 = 3.1, .q95 = 4.0});
  add("d", "A", {.q05 = 2.0, .q95 = 4.0, .unit = "min"});
  add("e", "B", {.q05 = 2.0, .q95 = 4.0});  // a wrong name's strength is nobody's
  const GapScores scores = gap_scores(population.cases(), {});
  EXPECT_EQ(*scores.effect_coverage->hits, 2);
  EXPECT_EQ(scores.effect_coverage->cases, 3);
  EXPECT_EQ(scores.other_units, 1);
}

// 1 … 20 s: median 10.5; the 95 % quantile lies 0.95 * 19 = 18.05 steps up: 19.05.
TEST(CostScores, SpreadByHand) {
  made_up::Population population;
  for (int i = 1; i <= 20; ++i) {
    const auto id = fmt::format("c{:02}", i);
    CaseResult result = said(id, Outcome::none);
    result.wall_s = i;
    population.add(made_up::nothing_hidden(id), result);
  }
  const CostScores scores = cost_scores(population.cases());
  EXPECT_DOUBLE_EQ(scores.wall_s->median->value, 10.5);
  EXPECT_DOUBLE_EQ(scores.wall_s->p95, 19.05);
  EXPECT_DOUBLE_EQ(scores.wall_s->max, 20.0);
  EXPECT_FALSE(scores.peak_rss_MB);
}

}  // namespace
}  // namespace recald::blind
