#include "tests/blind/scoring/targets.hpp"

#include <gtest/gtest.h>

#include "tests/blind/scoring/made_up.hpp"
#include "tests/blind/scoring/scores.hpp"

namespace recald::blind {
namespace {

using made_up::effect;
using made_up::named;
using made_up::said;

struct Verdicts {
  Verdict minimum;
  Verdict excellent;
};

bool operator==(const Verdicts& a, const Verdicts& b) {
  return a.minimum == b.minimum && a.excellent == b.excellent;
}

Verdicts verdicts_on(const made_up::Population& population, const std::string& quantity) {
  const Scores scores =
      compute_scores(population.key(), population.results(), population.classes(), {});
  for (const Target& target : scores.targets) {
    if (target.quantity == quantity) return {target.minimum, target.excellent};
  }
  ADD_FAILURE() << "no target " << quantity;
  return {};
}

/// `wrong` false names in `all` cases without an effect.
made_up::Population without_effect(int wrong, int all) {
  made_up::Population population;
  for (int i = 0; i < all; ++i) {
    const auto id = fmt::format("n{:03}", i);
    population.add(made_up::nothing_hidden(id),
                   i < wrong ? named(id, {"A"}) : said(id, Outcome::none));
  }
  return population;
}

// 2 % of our own world is reached by 2 of 100 and shown by 0 of 149.
TEST(Targets, AFalseNameCountsAsEveryOtherShare) {
  const std::string quantity = "false name where nothing is hidden";
  const auto verdict = [&](int wrong, int all) {
    return verdicts_on(without_effect(wrong, all), quantity).minimum;
  };
  EXPECT_EQ(verdict(3, 100), Verdict::missed);
  EXPECT_EQ(verdict(2, 100), Verdict::met_not_shown);
  EXPECT_EQ(verdict(0, 148), Verdict::met_not_shown);
  EXPECT_EQ(verdict(0, 149), Verdict::met);
}

/// `right` of `all` singles named that move so much.
made_up::Population singles(int right, int all, double share, const std::string& world = "own") {
  made_up::Population population;
  for (int i = 0; i < all; ++i) {
    const auto id = fmt::format("{}{:03}", world, i);
    Answer answer = made_up::single(id, made_up::moving("A", share));
    answer.world = world;
    population.add(answer, named(id, {i < right ? "A" : "B"}));
  }
  return population;
}

// 65 % is reached by 39 of 60 and shown by 46; 40 % by 24 and 31.
TEST(Targets, ASharedEstimateIsMetBeforeItIsShown) {
  const auto above_10 = [](int right) {
    return verdicts_on(singles(right, 60, 0.2), "named right, above 10 %").minimum;
  };
  EXPECT_EQ(above_10(38), Verdict::missed);
  EXPECT_EQ(above_10(39), Verdict::met_not_shown);
  EXPECT_EQ(above_10(45), Verdict::met_not_shown);
  EXPECT_EQ(above_10(46), Verdict::met);
  const auto from_3 = [](int right) {
    return verdicts_on(singles(right, 60, 0.05), "named right, 3 to 10 %").minimum;
  };
  EXPECT_EQ(from_3(23), Verdict::missed);
  EXPECT_EQ(from_3(24), Verdict::met_not_shown);
  EXPECT_EQ(from_3(31), Verdict::met);
}

TEST(Targets, WithoutCasesNothingIsSaid) {
  EXPECT_EQ(verdicts_on(singles(1, 1, 0.05), "named right, above 10 %"),
            (Verdicts{Verdict::no_cases, Verdict::no_cases}));
  EXPECT_EQ(verdicts_on(singles(1, 1, 0.05), "slowest case"),
            (Verdicts{Verdict::no_cases, Verdict::not_gated}));
}

// Ranked first everywhere, committed to never: the rank passes, and what was named does not.
TEST(Targets, WhatWasNamedStandsBesideTheRank) {
  made_up::Population population;
  for (int i = 0; i < 60; ++i) {
    const auto id = fmt::format("s{:03}", i);
    population.add(made_up::single(id, made_up::moving("A", 0.2)),
                   said(id, Outcome::none, {{"A", 0.6}, {"none", 0.4}}));
  }
  EXPECT_EQ(verdicts_on(population, "top-1, above 10 %").minimum, Verdict::met);
  EXPECT_EQ(verdicts_on(population, "named right, above 10 %").minimum, Verdict::missed);
}

// What is missed in the one world may be enough in the other; both stand in one table.
TEST(Targets, WorldsAreAskedForByThemselves) {
  made_up::Population both = singles(33, 60, 0.2);
  const made_up::Population other = singles(33, 60, 0.2, "energyplus");
  for (const auto& [id, answer] : other.key()) {
    both.add(answer, *std::ranges::find(other.results(), id, &CaseResult::case_id));
  }
  const Scores scores = compute_scores(both.key(), both.results(), both.classes(), {});
  std::map<std::string, Verdict> verdicts;
  for (const Target& target : scores.targets) {
    if (target.quantity == "named right, above 10 %") verdicts[target.world] = target.minimum;
  }
  EXPECT_EQ(verdicts, (std::map<std::string, Verdict>{{"own", Verdict::missed},
                                                      {"energyplus", Verdict::met_not_shown}}));
}

// An interval that covers always is as wrong as one that covers too rarely: 80 to 97 %.
TEST(Targets, CoverageHasTwoSides) {
  constexpr Goal goal{.min = 0.80, .max = 0.97};
  EXPECT_EQ(verdict_of(share_score(100, 100), goal, false), Verdict::missed);
  EXPECT_EQ(verdict_of(share_score(79, 100), goal, false), Verdict::missed);
  EXPECT_EQ(verdict_of(share_score(90, 100), goal, false), Verdict::met);
  EXPECT_EQ(verdict_of(share_score(9, 10), goal, false), Verdict::met_not_shown);
}

TEST(Targets, TheSlowestCaseIsJudgedAsItIs) {
  made_up::Population population;
  for (const auto& [id, wall_s] : {std::pair{"a", 9.0}, std::pair{"b", 10.5}}) {
    CaseResult result = said(id, Outcome::none);
    result.wall_s = wall_s;
    population.add(made_up::nothing_hidden(id), result);
  }
  EXPECT_EQ(verdicts_on(population, "slowest case").minimum, Verdict::missed);
}

TEST(Targets, MissingCasesAreListedByMethod) {
  made_up::Population population;
  for (const char* id : {"a", "b", "c", "d", "e", "f", "g"}) {
    population.add(made_up::nothing_hidden(id), said(id, Outcome::none, {}, "oracle"));
  }
  population.add(said("a", Outcome::none, {}, "aic"));
  EXPECT_EQ(missing_cases(population.key(), population.results(), "recald"),
            (std::vector<std::string>{
                "method aic: 6 of 7 cases have no result (b, c, d, e, f, ...)",
                "method recald: 7 of 7 cases have no result (a, b, c, d, e, ...)"}));
}

}  // namespace
}  // namespace recald::blind
