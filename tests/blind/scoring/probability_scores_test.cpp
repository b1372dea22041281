#include "tests/blind/scoring/probability_scores.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/blind/scoring/made_up.hpp"

namespace recald::blind {
namespace {

using made_up::effect;
using made_up::named;
using made_up::said;

// Case a: truth A. (0.7 - 1)^2 + 0.2^2 + 0.1^2 = 0.09 + 0.04 + 0.01 = 0.14; -ln 0.7 = 0.356675
// Case b: truth none. 0.7^2 + (0.2 - 1)^2 + 0.1^2 = 0.49 + 0.64 + 0.01 = 1.14; -ln 0.2 = 1.609438
// Case c: truth unknown. 0.49 + 0.04 + (0.1 - 1)^2 = 1.34; -ln 0.1 = 2.302585
TEST(ProbabilityScores, BrierAndLogLossByHand) {
  const std::map<std::string, double> p{{"A", 0.7}, {"none", 0.2}, {"unknown", 0.1}};
  made_up::Population population;
  population.add(made_up::single("a", effect("A")), said("a", Outcome::none, p));
  population.add(made_up::nothing_hidden("b"), said("b", Outcome::none, p));
  population.add(made_up::outside("c", "ev"), said("c", Outcome::none, p));
  const ProbabilityScores scores = probability_scores(population.cases(), 5);
  EXPECT_EQ(scores.cases, 3);
  EXPECT_NEAR(scores.brier->value, (0.14 + 1.14 + 1.34) / 3.0, 1e-12);
  EXPECT_NEAR(scores.log_loss->value, (0.356675 + 1.609438 + 2.302585) / 3.0, 1e-6);
  EXPECT_EQ(scores.floored, 0);
}

TEST(ProbabilityScores, AnOracleHasNoLossAndTheOppositeTheWorst) {
  made_up::Population population;
  population.add(made_up::single("a", effect("A")), named("a", {"A"}, {{"A", 1.0}}));
  population.add(made_up::nothing_hidden("b"), said("b", Outcome::none, {{"none", 1.0}}));
  const ProbabilityScores best = probability_scores(population.cases(), 5);
  EXPECT_EQ(best.brier->value, 0.0);
  EXPECT_EQ(best.log_loss->value, 0.0);
  EXPECT_EQ(best.ece->value, 0.0);

  made_up::Population opposite;
  opposite.add(made_up::single("a", effect("A")), said("a", Outcome::none, {{"none", 1.0}}));
  const ProbabilityScores worst = probability_scores(opposite.cases(), 5);
  EXPECT_EQ(worst.brier->value, 2.0);
  EXPECT_NEAR(worst.log_loss->value, -std::log(1e-6), 1e-12);
  EXPECT_EQ(worst.floored, 1);
  EXPECT_EQ(worst.ece->value, 1.0);
}

/// `right` of `all` cases in which "none" has probability p and is true.
void add_stated(made_up::Population& population, double p, int right, int all) {
  for (int i = 0; i < all; ++i) {
    const auto id = fmt::format("c{:04}", population.results().size());
    const CaseResult result = said(id, Outcome::none, {{"none", p}, {"unknown", 1.0 - p}});
    population.add(i < right ? made_up::nothing_hidden(id) : made_up::outside(id, "ev"), result);
  }
}

// 0.9 stated and 6 of 10 right; 0.7 stated and 7 of 10 right:
// ECE = 10/20 |0.6 - 0.9| + 10/20 |0.7 - 0.7| = 0.15.
TEST(ProbabilityScores, MiscalibrationByHand) {
  made_up::Population population;
  add_stated(population, 0.9, 6, 10);
  add_stated(population, 0.7, 7, 10);
  const ProbabilityScores scores = probability_scores(population.cases(), 5);
  EXPECT_NEAR(scores.ece->value, 0.15, 1e-12);
  ASSERT_EQ(scores.bins.size(), 5u);
  EXPECT_EQ(scores.bins[3].cases, 10);  // 0.6 to 0.8
  EXPECT_NEAR(scores.bins[3].mean_probability, 0.7, 1e-12);
  EXPECT_EQ(*scores.bins[3].right->hits, 7);
  EXPECT_EQ(scores.bins[4].cases, 10);  // 0.8 to 1
  EXPECT_NEAR(scores.bins[4].mean_probability, 0.9, 1e-12);
  EXPECT_EQ(*scores.bins[4].right->hits, 6);
  EXPECT_EQ(scores.bins[0].cases, 0);
  EXPECT_FALSE(scores.bins[0].right);
}

// In one bin of 0.8 to 1 errors of either sign cancel, in two they do not:
// 0.85 with 10 of 10 right (+0.15) and 0.95 with 8 of 10 (-0.15).
TEST(ProbabilityScores, BinsAreAsManyAsAskedFor) {
  made_up::Population population;
  add_stated(population, 0.85, 10, 10);
  add_stated(population, 0.95, 8, 10);
  EXPECT_NEAR(probability_scores(population.cases(), 5).ece->value, 0.0, 1e-12);
  EXPECT_NEAR(probability_scores(population.cases(), 10).ece->value, 0.15, 1e-12);
}

TEST(ProbabilityScores, OneBelongsToTheLastBin) {
  made_up::Population population;
  add_stated(population, 1.0, 1, 1);
  EXPECT_EQ(probability_scores(population.cases(), 5).bins.back().cases, 1);
}

// Both effects of a pair are right answers; one truth, which Brier needs, there is not.
TEST(ProbabilityScores, PairsCountForReliabilityOnly) {
  made_up::Population population;
  population.add(made_up::pair("p", effect("A"), effect("B")),
                 named("p", {"A", "B"}, {{"A", 0.4}, {"B", 0.6}}));
  const ProbabilityScores scores = probability_scores(population.cases(), 5);
  EXPECT_FALSE(scores.brier);
  EXPECT_FALSE(scores.log_loss);
  EXPECT_NEAR(scores.ece->value, 0.4, 1e-12);  // B with 0.6, right
}

TEST(ProbabilityScores, ATiedTruthIsNotTheFirstAnswer) {
  for (const char* truth : {"A", "B"}) {
    made_up::Population population;
    population.add(made_up::single("s", effect(truth)),
                   said("s", Outcome::none, {{"A", 0.4}, {"B", 0.4}, {"none", 0.2}}));
    // 0.4 stated and wrong; right it would be 0.6.
    EXPECT_NEAR(probability_scores(population.cases(), 5).ece->value, 0.4, 1e-12) << truth;
  }
}

TEST(ProbabilityScores, KindsOfAnswerStandApart) {
  made_up::Population population;
  add_stated(population, 0.9, 3, 4);
  population.add(made_up::single("s1", effect("A")), named("s1", {"A"}, {{"A", 0.8}, {"B", 0.2}}));
  population.add(made_up::single("s2", effect("A")), named("s2", {"B"}, {{"B", 1.0}}));
  const ProbabilityScores scores = probability_scores(population.cases(), 5);
  ASSERT_EQ(scores.kinds.size(), 3u);
  EXPECT_EQ(scores.kinds[0].kind, "a name");
  EXPECT_EQ(scores.kinds[0].cases, 2);
  EXPECT_NEAR(scores.kinds[0].mean_probability, 0.9, 1e-12);
  EXPECT_EQ(*scores.kinds[0].right->hits, 1);
  EXPECT_EQ(scores.kinds[1].kind, "none");
  EXPECT_EQ(*scores.kinds[1].right->hits, 3);
  EXPECT_EQ(scores.kinds[2].kind, "unknown");
  EXPECT_EQ(scores.kinds[2].cases, 0);
}

// Said with 0.85 and right; with 0.80 and wrong; with 0.79, below; thought with 0.9 but not said.
TEST(ProbabilityScores, SureNamesAreThoseSaidWithEightTenths) {
  made_up::Population population;
  const auto p = [](double a) {
    return std::map<std::string, double>{{"A", a}, {"none", 1.0 - a}};
  };
  population.add(made_up::single("s1", effect("A")), named("s1", {"A"}, p(0.85)));
  population.add(made_up::nothing_hidden("s2"), named("s2", {"A"}, p(0.80)));
  population.add(made_up::nothing_hidden("s3"), named("s3", {"A"}, p(0.79)));
  population.add(made_up::nothing_hidden("s4"), said("s4", Outcome::none, p(0.90)));
  const ProbabilityScores scores = probability_scores(population.cases(), 5);
  ASSERT_TRUE(scores.sure_names_right);
  EXPECT_EQ(*scores.sure_names_right->hits, 1);
  EXPECT_EQ(scores.sure_names_right->cases, 2);
}

// Singles: A 0.95 right, A 0.6 wrong. Nothing hidden: A 0.7 first; none first.
TEST(ProbabilityScores, AbstentionByHand) {
  made_up::Population population;
  const auto p = [](double a) {
    return std::map<std::string, double>{{"A", a}, {"none", 1.0 - a}};
  };
  population.add(made_up::single("s1", effect("A")), said("s1", Outcome::none, p(0.95)));
  population.add(made_up::single("s2", effect("B")), said("s2", Outcome::none, p(0.6)));
  population.add(made_up::nothing_hidden("n1"), said("n1", Outcome::none, p(0.7)));
  population.add(made_up::nothing_hidden("n2"), said("n2", Outcome::none, p(0.1)));
  const ProbabilityScores scores = probability_scores(population.cases(), 5);
  struct Row {
    double threshold;
    int coverage, right, named, false_names;
  };
  for (const Row& row : {Row{0.0, 2, 1, 3, 1}, Row{0.6, 2, 1, 3, 1}, Row{0.7, 1, 1, 2, 1},
                         Row{0.8, 1, 1, 1, 0}, Row{0.95, 1, 1, 1, 0}}) {
    SCOPED_TRACE(row.threshold);
    const auto point =
        std::ranges::find(scores.abstention, row.threshold, &AbstentionPoint::threshold);
    ASSERT_NE(point, scores.abstention.end());
    EXPECT_EQ(*point->coverage->hits, row.coverage);
    EXPECT_EQ(point->coverage->cases, 2);
    EXPECT_EQ(*point->accuracy->hits, row.right);
    EXPECT_EQ(point->accuracy->cases, row.named);
    EXPECT_EQ(*point->false_names->hits, row.false_names);
  }
  EXPECT_FALSE(scores.abstention.back().accuracy);  // from 0.99 on nothing is named
}

TEST(ProbabilityScores, AMethodWithoutProbabilitiesHasNone) {
  made_up::Population population;
  population.add(made_up::nothing_hidden("a"), said("a", Outcome::none));
  const ProbabilityScores scores = probability_scores(population.cases(), 5);
  EXPECT_EQ(scores.cases, 0);
  EXPECT_FALSE(scores.brier);
  EXPECT_FALSE(scores.ece);
}

// Said with 0.9 and right in 3 of 4: p^s / (p^s + (1 - p)^s) = 0.75 at s = ln 3 / ln 9 = 0.5.
TEST(ProbabilityScores, TheSlopeTellsHowMuchTooSureTheyAre) {
  const auto slope_of = [](double p, int right, int all) {
    made_up::Population population;
    for (int i = 0; i < all; ++i) {
      const auto id = fmt::format("s{:03}", i);
      population.add(
          made_up::single(id, effect("A")),
          said(id, Outcome::none, {{i < right ? "A" : "B", p}, {i < right ? "B" : "A", 1.0 - p}}));
    }
    return probability_scores(population.cases(), 5).slope->value;
  };
  EXPECT_NEAR(slope_of(0.9, 75, 100), 0.5, 0.02);
  EXPECT_NEAR(slope_of(0.9, 90, 100), 1.0, 0.04);
  EXPECT_NEAR(slope_of(0.7, 90, 100), std::log(9.0) / std::log(7.0 / 3.0), 0.06);
}

}  // namespace
}  // namespace recald::blind
