#include "tests/blind/scoring/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/blind/scoring/made_up.hpp"

namespace recald::blind {
namespace {

using made_up::effect;
using made_up::named;
using made_up::said;
using ::testing::HasSubstr;
using ::testing::Not;

Scores scores_of(const made_up::Population& population) {
  return compute_scores(population.key(), population.results(), population.classes(), {});
}

std::string page_of(const made_up::Population& population) {
  return scores_markdown(scores_of(population), {});
}

// Three nothings, one of them named and one left in doubt: 1 of 3 and 2 of 3. The one-sided bound
// of 1 of 3 solves (1 - p)^3 + 3 p (1 - p)^2 = 0.05: p = 0.865.
TEST(Report, FalseNamesCarryTheirOneSidedBound) {
  made_up::Population population;
  population.add(made_up::nothing_hidden("a"), named("a", {"A"}));
  population.add(made_up::nothing_hidden("b"), said("b", Outcome::unknown));
  population.add(made_up::nothing_hidden("c"), said("c", Outcome::none));
  const std::string page = page_of(population);
  EXPECT_THAT(page, HasSubstr("| nothing hidden, yet an effect named | 1 of 3: 33 % (0.8 to 91), "
                              "at most 86.5 % (one-sided) |\n"));
  EXPECT_THAT(page, HasSubstr("| nothing hidden, yet not said so | 2 of 3: 67 % (9 to 99.2) |\n"));
  EXPECT_THAT(page, HasSubstr("## Probabilities\n\nThe results give none.\n"));
  EXPECT_THAT(page, HasSubstr("## Time and memory\n\nNot stated.\n"));
}

TEST(Report, WhatCouldNotBeScoredIsSaid) {
  made_up::Population population;
  CaseResult first = named("a", {"A"});
  first.effect_parameter = {.q05 = 0.0, .q95 = 9.0, .unit = "min"};
  first.parameters_after = {{"zone_mass", {.mean = 1.0}}};
  const FitOfMeter before{{"steam", {.log_score = -3.0, .cvrmse = 0.2}}};
  const FitOfMeter after{{"steam", {.log_score = -2.0, .cvrmse = 0.1}}};
  first.gap = Gap{.before = before, .after = after, .oracle = after};
  population.add(made_up::single("a", effect("A")), first);
  population.add(made_up::single("b", effect("A")), named("b", {"A"}));
  const std::string page = page_of(population);
  EXPECT_THAT(page, HasSubstr("R is known for 1 of 2 named cases;"));
  EXPECT_THAT(page, HasSubstr("2 additions came without figures for other meters."));
  EXPECT_THAT(page, HasSubstr("1 intervals of effects are in another unit"));
  EXPECT_THAT(page, HasSubstr("Parameters without a known truth, left out: zone_mass."));
}

TEST(Report, WhatIsCompleteIsNotExcused) {
  made_up::Population population;
  population.add(made_up::nothing_hidden("a"), said("a", Outcome::none));
  const std::string page = page_of(population);
  EXPECT_THAT(page, Not(HasSubstr("R is known for")));
  EXPECT_THAT(page, Not(HasSubstr("additions came without")));
  EXPECT_THAT(page, Not(HasSubstr("left out")));
}

// Most frequent first: what a truth is mostly taken for stands where the eye falls.
TEST(Report, ConfusionsStandByFrequency) {
  made_up::Population population;
  population.add(made_up::single("a", effect("A")), named("a", {"B"}));
  population.add(made_up::single("b", effect("A")), said("b", Outcome::none));
  population.add(made_up::single("c", effect("A")), said("c", Outcome::none));
  population.add(made_up::outside("d", "ev_charging"), named("d", {"B"}));
  const std::string page = page_of(population);
  EXPECT_THAT(page, HasSubstr("| A | none (2), B (1) |\n"));
  EXPECT_THAT(page, HasSubstr("| unknown (ev_charging) | B (1) |\n"));
}

TEST(Report, MethodsStandInOneTableWithTheirDifference) {
  made_up::Population population;
  for (const char* id : {"a", "b", "c", "d", "e", "f"}) {
    population.add(made_up::nothing_hidden(id), said(id, Outcome::none));
    population.add(named(id, {"A"}, {}, "residual_regression"));
  }
  const std::string page = page_of(population);
  EXPECT_THAT(page, HasSubstr("| residual_regression | 6 | 0 of 6: 0 % (0 to 46) |"));
  EXPECT_THAT(page,
              HasSubstr("| residual_regression | 6 | 6 | 0 | 100 % (100 to 100) | 0.031 | - | "
                        "beaten |\n"));
}

// A version or unit in a broken encoding must not stop the scores from being written.
TEST(Report, BrokenTextIsReplaced) {
  made_up::Population population;
  CaseResult result = said("a", Outcome::none);
  result.version = "recald \xff";
  population.add(made_up::nothing_hidden("a"), result);
  const std::string text = scores_json(scores_of(population), {});
  EXPECT_TRUE(nlohmann::json::accept(text));
}

TEST(Report, ThePageShowsEachWorldByItself) {
  made_up::Population population;
  Answer other = made_up::single("b", made_up::moving("B<", 0.2));
  other.world = "energyplus";
  population.add(made_up::single("a", made_up::moving("A", 0.2)), named("a", {"A"}, {{"A", 1.0}}));
  population.add(other, named("b", {"C"}, {{"C", 0.9}, {"none", 0.1}}));
  const std::string page = scores_html(scores_of(population), {});
  EXPECT_THAT(page, HasSubstr("Buildings of our own simulator: 1 cases"));
  EXPECT_THAT(page, HasSubstr("Buildings of EnergyPlus: 1 cases"));
  EXPECT_THAT(page, HasSubstr("right: single, above 10 %, 1 of 1"));
  EXPECT_THAT(page, HasSubstr("wrong name, something hidden, 1 of 1"));
  EXPECT_THAT(page, HasSubstr("<td>B&lt;</td><td>C (1)</td>"));
  EXPECT_THAT(page, Not(HasSubstr("http")));
}

}  // namespace
}  // namespace recald::blind
