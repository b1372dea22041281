#include "tests/blind/scoring/comparison.hpp"

#include <gtest/gtest.h>

#include "tests/blind/scoring/made_up.hpp"

namespace recald::blind {
namespace {

using made_up::effect;
using made_up::named;
using made_up::said;

// Closed forms of the coin: 5 against 0: 2 / 2^5 = 0.0625. 6 against 0: 2 / 2^6 = 0.03125.
// 8 against 2: 2 (1 + 10 + 45) / 2^10 = 0.109375. Even: cannot exceed one.
TEST(Comparison, McNemarMeetsClosedForms) {
  EXPECT_NEAR(mcnemar_exact(5, 0), 0.0625, 1e-12);
  EXPECT_NEAR(mcnemar_exact(0, 6), 0.03125, 1e-12);
  EXPECT_NEAR(mcnemar_exact(8, 2), 0.109375, 1e-12);
  EXPECT_EQ(mcnemar_exact(4, 4), 1.0);
  EXPECT_EQ(mcnemar_exact(0, 0), 1.0);
}

/// Twenty singles: both methods right in `both`, the main one alone in `main`, the other in
/// `other`, the rest in neither.
made_up::Population duel(int both, int main, int other) {
  made_up::Population population;
  for (int i = 0; i < 20; ++i) {
    const auto id = fmt::format("c{:02}", i);
    const bool main_right = i < both + main;
    const bool other_right = i < both || (i >= both + main && i < both + main + other);
    population.add(made_up::single(id, effect("A")), named(id, {main_right ? "A" : "B"}));
    population.add(named(id, {other_right ? "A" : "B"}, {}, "aic"));
  }
  return population;
}

PairedDifference difference_of(const made_up::Population& population) {
  return paired_difference(population.cases(), population.cases("aic"), {});
}

// 6 alone against 0 of 20: difference 0.3, p 0.031. 5 against 0: p 0.0625. 3 against 3: level.
TEST(Comparison, VerdictsGoByTheCasesInWhichTheMethodsDiffer) {
  const PairedDifference clear = difference_of(duel(10, 6, 0));
  EXPECT_EQ(clear.cases, 20);
  EXPECT_EQ(clear.only_main_right, 6);
  EXPECT_EQ(clear.only_other_right, 0);
  EXPECT_NEAR(clear.right->value, 0.3, 1e-12);
  EXPECT_GT(clear.right->interval->low, 0.0);
  EXPECT_EQ(clear.verdict, Comparison::beaten);
  EXPECT_EQ(difference_of(duel(10, 5, 0)).verdict, Comparison::not_shown);
  EXPECT_EQ(difference_of(duel(10, 3, 3)).verdict, Comparison::not_beaten);
  EXPECT_EQ(difference_of(duel(10, 0, 6)).verdict, Comparison::not_beaten);
}

TEST(Comparison, OnlySharedCasesCount) {
  made_up::Population population;
  population.add(made_up::nothing_hidden("a"), said("a", Outcome::none));
  population.add(made_up::nothing_hidden("b"), said("b", Outcome::none));
  population.add(said("b", Outcome::unknown, {}, "aic"));
  const PairedDifference difference = difference_of(population);
  EXPECT_EQ(difference.cases, 1);
  EXPECT_EQ(difference.only_main_right, 1);
}

// R of the main method 0.9, of the other 0.4 in the same case.
TEST(Comparison, GapsAreComparedCaseByCase) {
  const auto gap = [](double share) {
    const auto fit = [](double cvrmse) {
      return FitOfMeter{{"steam", {.log_score = -10.0 * cvrmse, .cvrmse = cvrmse}}};
    };
    return Gap{.before = fit(0.2), .after = fit(0.2 - 0.1 * share), .oracle = fit(0.1)};
  };
  made_up::Population population;
  CaseResult ours = named("a", {"A"});
  ours.gap = gap(0.9);
  CaseResult theirs = named("a", {"A"}, {}, "aic");
  theirs.gap = gap(0.4);
  population.add(made_up::single("a", effect("A")), ours);
  population.add(theirs);
  EXPECT_NEAR(difference_of(population).gap->value, 0.5, 1e-12);
}

TEST(Comparison, TheMainMethodComesFirstAndTheOracleIsNoRival) {
  made_up::Population population;
  population.add(made_up::single("a", effect("A")), named("a", {"A"}));
  population.add(said("a", Outcome::none, {}, "unknown_only"));
  population.add(said("a", Outcome::none, {}, "aic"));
  population.add(named("a", {"A"}, {}, "oracle"));
  const auto rows =
      compare_methods(population.key(), population.results(), "recald", population.classes());
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].method, "recald");
  EXPECT_FALSE(rows[0].against);
  EXPECT_EQ(*rows[0].single_top1->hits, 1);
  EXPECT_EQ(rows[1].method, "aic");
  EXPECT_EQ(*rows[1].single_top1->hits, 0);
  EXPECT_EQ(rows[2].method, "unknown_only");
  EXPECT_TRUE(rows[2].against);
}

}  // namespace
}  // namespace recald::blind
