#include "tests/blind/scoring/naming_scores.hpp"

#include <gtest/gtest.h>

#include "core/random/rng.hpp"
#include "tests/blind/scoring/made_up.hpp"

namespace recald::blind {
namespace {

using made_up::effect;
using made_up::named;
using made_up::said;

GroupScores group_of(const NamingScores& scores, const std::string& group) {
  const auto found = std::ranges::find(scores.groups, group, &GroupScores::group);
  return found == scores.groups.end() ? GroupScores{} : *found;
}

/// hits of cases, or (-1, -1) where there is no score.
std::pair<int, int> counts(const std::optional<Score>& score) {
  return score ? std::pair{*score->hits, score->cases} : std::pair{-1, -1};
}

using Counts = std::pair<int, int>;

/// Two of nothing, three singles, a pair, an effect out of the catalogue and a decoy alone.
std::vector<Answer> one_of_each() {
  return {made_up::nothing_hidden("n1"),
          made_up::nothing_hidden("n2"),
          made_up::single("s1", effect("setback", "schedules")),
          made_up::single("s2", effect("holiday", "schedules")),
          made_up::single("s3", effect("infiltration", "envelope")),
          made_up::pair("p1", effect("setback", "schedules"), effect("economiser", "outdoor_air")),
          made_up::outside("o1", "ev_charging"),
          made_up::decoy_only("o2")};
}

/// What a perfect method says.
CaseResult truth_said(const Answer& answer) {
  if (answer.block == Block::out_of_catalogue && !answer.effects.empty()) {
    return said(answer.case_id, Outcome::unknown, {{"unknown", 1.0}});
  }
  if (answer.effects.empty()) return said(answer.case_id, Outcome::none, {{"none", 1.0}});
  std::vector<std::string> names;
  for (const HiddenEffect& hidden : answer.effects) names.push_back(hidden.effect);
  std::map<std::string, double> probabilities;
  for (const std::string& name : names) {
    probabilities[name] = 1.0 / static_cast<double>(names.size());
  }
  return named(answer.case_id, names, probabilities);
}

TEST(NamingScores, AnOracleScoresOneEverywhere) {
  made_up::Population population;
  for (const Answer& answer : one_of_each()) population.add(answer, truth_said(answer));
  const NamingScores scores = naming_scores(population.cases());
  EXPECT_EQ(counts(scores.right), (Counts{8, 8}));
  for (const GroupScores& group : scores.groups) {
    SCOPED_TRACE(group.group);
    EXPECT_EQ(counts(group.right), (Counts{group.cases, group.cases}));
    EXPECT_EQ(counts(group.top1), (Counts{group.cases, group.cases}));
    EXPECT_EQ(counts(group.top3), (Counts{group.cases, group.cases}));
    EXPECT_EQ(counts(group.wrong_name), (Counts{0, group.cases}));
  }
  EXPECT_EQ(counts(group_of(scores, kAllSingles).class_right), (Counts{3, 3}));
  EXPECT_EQ(counts(scores.false_names), (Counts{0, 2}));
  EXPECT_EQ(counts(scores.false_alarms), (Counts{0, 2}));
  EXPECT_EQ(counts(scores.out_of_catalogue_wrong_name), (Counts{0, 2}));
  EXPECT_EQ(counts(scores.out_of_catalogue_unknown), (Counts{1, 1}));
  EXPECT_EQ(counts(scores.pairs.both), (Counts{1, 1}));
  EXPECT_EQ(counts(scores.decoys.right), (Counts{1, 1}));
}

TEST(NamingScores, AlwaysNoneIsRightOnlyWhereNothingIsHidden) {
  made_up::Population population;
  for (const Answer& answer : one_of_each()) {
    population.add(answer, said(answer.case_id, Outcome::none));
  }
  const NamingScores scores = naming_scores(population.cases());
  EXPECT_EQ(counts(scores.right), (Counts{3, 8}));  // n1, n2 and the decoy
  EXPECT_EQ(counts(group_of(scores, "no effect").top1), (Counts{2, 2}));
  EXPECT_EQ(counts(group_of(scores, kAllSingles).top1), (Counts{0, 3}));
  EXPECT_EQ(counts(group_of(scores, kAllSingles).top3), (Counts{0, 3}));
  EXPECT_EQ(counts(group_of(scores, kAllSingles).said_none), (Counts{3, 3}));
  EXPECT_EQ(counts(scores.false_names), (Counts{0, 2}));
  EXPECT_EQ(counts(scores.out_of_catalogue_unknown), (Counts{0, 1}));
  EXPECT_EQ(counts(scores.pairs.neither), (Counts{1, 1}));
}

// Forty effects and "none" and "unknown", a random order each time: first with 1/42, among the
// first three with 3/42. 4200 cases: 100 +- 9.9 and 300 +- 16.7; bounds of four standard errors.
TEST(NamingScores, ARandomGuesserScoresByChance) {
  constexpr int effects = 40;
  constexpr int cases = 4200;
  Rng rng(5);
  made_up::Population population;
  for (int i = 0; i < cases; ++i) {
    const auto id = fmt::format("s{:04}", i);
    std::map<std::string, double> probabilities{{"none", rng.uniform()},
                                                {"unknown", rng.uniform()}};
    for (int k = 0; k < effects; ++k) probabilities[fmt::format("e{}", k)] = rng.uniform();
    const auto truth = fmt::format("e{}", rng.below(effects));
    population.add(made_up::single(id, effect(truth, "c" + truth)),
                   said(id, Outcome::none, probabilities));
  }
  const GroupScores singles = group_of(naming_scores(population.cases()), kAllSingles);
  EXPECT_NEAR(*singles.top1->hits, 100, 40);
  EXPECT_NEAR(*singles.top3->hits, 300, 67);
}

// P: none 0.4, A 0.3, unknown 0.2, B 0.1. A is second: in the first three. B is fourth.
TEST(NamingScores, NoneAndUnknownTakeTheirPlacesInTheRanking) {
  const std::map<std::string, double> p{{"none", 0.4}, {"A", 0.3}, {"unknown", 0.2}, {"B", 0.1}};
  const auto of_truth = [&](const char* truth) {
    return judge(made_up::single("s", effect(truth)), said("s", Outcome::none, p), {});
  };
  EXPECT_FALSE(of_truth("A").top1);
  EXPECT_TRUE(of_truth("A").top3);
  EXPECT_FALSE(of_truth("B").top3);
}

// Equal probabilities: were the truth taken first, a method could say 1/42 of everything and be
// right each time.
TEST(NamingScores, ATieEarnsNothing) {
  const std::map<std::string, double> p{{"none", 0.25}, {"A", 0.25}, {"B", 0.25}, {"C", 0.25}};
  for (const char* truth : {"A", "B", "C"}) {
    const Judgement judgement =
        judge(made_up::single("s", effect(truth)), said("s", Outcome::none, p), {});
    EXPECT_FALSE(judgement.top1) << truth;
    EXPECT_FALSE(judgement.top3) << truth;
  }
}

// What was said goes before what was thought: A was added, though B was more probable at first.
TEST(NamingScores, TheNameAddedComesFirst) {
  const std::map<std::string, double> p{{"A", 0.4}, {"B", 0.6}};
  const CaseResult result = named("s", {"A"}, p);
  EXPECT_TRUE(judge(made_up::single("s", effect("A")), result, {}).top1);
  EXPECT_FALSE(judge(made_up::single("s", effect("B")), result, {}).top1);
  EXPECT_TRUE(judge(made_up::single("s", effect("B")), result, {}).top3);
}

TEST(NamingScores, ASecondNameThatIsNotThereSpoilsTheAnswer) {
  const Judgement judgement =
      judge(made_up::single("s", effect("A")), named("s", {"A", "B"}), {{"A", "x"}});
  EXPECT_TRUE(judgement.top1);
  EXPECT_FALSE(judgement.right);
  EXPECT_TRUE(judgement.wrong_name);
  EXPECT_EQ(judgement.hidden_named, 1);
  EXPECT_EQ(judgement.said, "A + B");
}

TEST(NamingScores, PairsAreCountedByHowManyWereNamed) {
  made_up::Population population;
  const auto add = [&](const char* id, CaseResult result) {
    population.add(made_up::pair(id, effect("A"), effect("B")), std::move(result));
  };
  add("p1", named("p1", {"B", "A"}));
  add("p2", named("p2", {"A"}));
  add("p3", named("p3", {"A", "C"}));
  add("p4", named("p4", {"C"}));
  add("p5", named("p5", {"A", "B", "C"}));
  add("p6", said("p6", Outcome::unknown));
  const NamingScores scores = naming_scores(population.cases());
  EXPECT_EQ(counts(scores.pairs.both), (Counts{2, 6}));  // p1, p5
  EXPECT_EQ(counts(scores.pairs.both_large), (Counts{2, 6}));
  EXPECT_EQ(counts(scores.pairs.only_one), (Counts{2, 6}));  // p2, p3
  EXPECT_EQ(counts(scores.pairs.neither), (Counts{2, 6}));   // p4, p6
  EXPECT_EQ(counts(scores.right), (Counts{1, 6}));           // p1
  EXPECT_EQ(counts(group_of(scores, "pair").wrong_name), (Counts{3, 6}));
  EXPECT_EQ(scores.confusion.at("A + B").at("A + B"), 1);
  EXPECT_EQ(scores.confusion.at("A + B").at("A + B + C"), 1);
  EXPECT_EQ(scores.confusion.at("A + B").at("unknown"), 1);
}

TEST(NamingScores, OfTwoEffectsTheWeakerOneCounts) {
  EXPECT_TRUE(is_large(made_up::pair("p", effect("A"), effect("B"))));
  EXPECT_FALSE(is_large(made_up::nothing_hidden("n")));
  const Answer answer = made_up::pair("p", made_up::moving("A", 0.2), made_up::moving("B", 0.02));
  EXPECT_EQ(largest_share(answer), 0.02);
  EXPECT_FALSE(is_large(answer));
  made_up::Population population;
  population.add(answer, named("p", {"A", "B"}));
  const NamingScores scores = naming_scores(population.cases());
  EXPECT_EQ(counts(scores.pairs.both), (Counts{1, 1}));
  EXPECT_FALSE(scores.pairs.both_large);
}

// The class of a name that is hidden nowhere comes from the list; a name without a class is wrong.
TEST(NamingScores, ClassesAreTheAnswersOrListed) {
  const Answer answer = made_up::single("s", effect("A", "schedules"));
  const EffectClasses classes{{"A", "schedules"}, {"B", "schedules"}, {"C", "plant"}};
  EXPECT_TRUE(judge(answer, named("s", {"A"}), classes).class_right);
  EXPECT_TRUE(judge(answer, named("s", {"B"}), classes).class_right);
  EXPECT_FALSE(judge(answer, named("s", {"C"}), classes).class_right);
  EXPECT_FALSE(judge(answer, named("s", {"D"}), classes).class_right);
  EXPECT_FALSE(judge(answer, said("s", Outcome::none), classes).class_right);
}

TEST(NamingScores, TwoClassesOfOneEffectAreAnError) {
  AnswerKey key;
  key.emplace("a", made_up::single("a", effect("A", "schedules")));
  key.emplace("b", made_up::single("b", effect("A", "plant")));
  const auto classes = classes_of(key, {});
  ASSERT_FALSE(classes.has_value());
  EXPECT_EQ(classes.error().message,
            "answer b: effect A is of class plant, but of class schedules elsewhere");
}

TEST(NamingScores, SinglesAreScoredByTheShareThatTheyMove) {
  made_up::Population population;
  population.add(made_up::single("a", made_up::moving("A", 0.03)), named("a", {"A"}));
  population.add(made_up::single("b", made_up::moving("B", 0.099)), named("b", {"A"}));
  population.add(made_up::single("c", made_up::moving("C", 0.1)), named("c", {"C"}));
  population.add(made_up::single("d", made_up::moving("D", 0.009)), said("d", Outcome::unknown));
  // Without moved shares the net ones count: steam -10 %.
  population.add(made_up::single("e", effect("E")), named("e", {"E"}));
  const NamingScores scores = naming_scores(population.cases());
  EXPECT_EQ(counts(group_of(scores, "single, 3 to 10 %").top1), (Counts{1, 2}));
  EXPECT_EQ(counts(group_of(scores, "single, 3 to 10 %").wrong_name), (Counts{1, 2}));
  EXPECT_EQ(counts(group_of(scores, "single, above 10 %").top1), (Counts{2, 2}));
  EXPECT_EQ(counts(group_of(scores, "single, below 1 %").said_unknown), (Counts{1, 1}));
  EXPECT_EQ(counts(group_of(scores, kAllSingles).top1), (Counts{3, 5}));
  EXPECT_EQ(counts(scores.wrong_names), (Counts{1, 5}));
}

TEST(NamingScores, AConfusableSetIsTheOneGivenOrTheProbableNames) {
  CaseResult given = said("s", Outcome::confusable, {{"A", 0.5}, {"B", 0.4}, {"none", 0.1}});
  EXPECT_EQ(confusable_set(given), (std::vector<std::string>{"A", "B"}));
  given.confusable = {"B", "C"};
  EXPECT_EQ(confusable_set(given), given.confusable);

  const Answer answer = made_up::single("s", effect("C"));
  EXPECT_TRUE(judge(answer, given, {}).set_has_truth);
  EXPECT_FALSE(judge(answer, given, {}).right);
  EXPECT_FALSE(judge(answer, said("s", Outcome::none, {{"C", 1.0}}), {}).set_has_truth);
}

TEST(NamingScores, FalseAlarmsAreMoreThanFalseNames) {
  made_up::Population population;
  population.add(made_up::nothing_hidden("a"), said("a", Outcome::unknown));
  population.add(made_up::nothing_hidden("b"), said("b", Outcome::confusable));
  population.add(made_up::nothing_hidden("c"), named("c", {"A"}));
  population.add(made_up::nothing_hidden("d"), said("d", Outcome::none));
  const NamingScores scores = naming_scores(population.cases());
  EXPECT_EQ(counts(scores.false_names), (Counts{1, 4}));
  EXPECT_EQ(counts(scores.false_alarms), (Counts{3, 4}));
}

// A decoy causes nothing: "unknown" is not a false name there, but not right either.
TEST(NamingScores, DecoysAloneAreNothing) {
  made_up::Population population;
  population.add(made_up::decoy_only("a"), said("a", Outcome::none));
  population.add(made_up::decoy_only("b"), said("b", Outcome::unknown));
  population.add(made_up::decoy_only("c"), named("c", {"wind"}));
  const NamingScores scores = naming_scores(population.cases());
  EXPECT_EQ(counts(scores.decoys.right), (Counts{1, 3}));
  EXPECT_EQ(counts(scores.decoys.wrong_name), (Counts{1, 3}));
  EXPECT_EQ(counts(scores.out_of_catalogue_wrong_name), (Counts{1, 3}));
  EXPECT_FALSE(scores.out_of_catalogue_unknown);
}

TEST(NamingScores, PlacesAreTheMeterMostAffected) {
  made_up::Population population;
  const auto add = [&](const char* id, std::optional<std::vector<std::string>> located) {
    CaseResult result = said(id, Outcome::unknown);
    result.located = std::move(located);
    population.add(made_up::single(id, effect("A")), result);  // steam -10 %, electricity 3 %
  };
  add("a", {{"steam", "electricity"}});
  add("b", {{"electricity", "steam"}});
  add("c", {{"electricity"}});
  add("d", std::vector<std::string>{});
  add("e", std::nullopt);
  add("f", {{"steam", "water"}});
  const NamingScores scores = naming_scores(population.cases());
  EXPECT_EQ(counts(scores.places.first_meter_right), (Counts{2, 5}));  // a, f
  EXPECT_EQ(counts(scores.places.found_among_all), (Counts{3, 5}));    // a, b, f
}

TEST(NamingScores, RightAnswersAreCountedByClimateUseAndGaps) {
  made_up::Population population;
  Answer warm = made_up::nothing_hidden("a");
  warm.climate = "hot-dry";
  warm.gaps = true;
  population.add(warm, said("a", Outcome::none));
  population.add(made_up::nothing_hidden("b"), said("b", Outcome::unknown));
  std::map<std::string, Counts> found;
  for (const Breakdown& row : naming_scores(population.cases()).breakdowns) {
    found[row.what] = counts(row.right);
  }
  EXPECT_EQ(found, (std::map<std::string, Counts>{{"climate cold", {0, 1}},
                                                  {"climate hot-dry", {1, 1}},
                                                  {"use office", {1, 2}},
                                                  {"with gaps", {1, 1}},
                                                  {"without gaps", {0, 1}}}));
}

TEST(NamingScores, AResultWithoutAnAnswerIsNamed) {
  AnswerKey key;
  key.emplace("a", made_up::nothing_hidden("a"));
  const std::vector results{said("a", Outcome::none), said("z", Outcome::none, {}, "aic")};
  const auto known = check_cases_known(key, results);
  ASSERT_FALSE(known.has_value());
  EXPECT_EQ(known.error().code, ErrorCode::not_found);
  EXPECT_EQ(known.error().message,
            "the results of method aic name the case z, to which there is no answer; results of "
            "another population?");
}

}  // namespace
}  // namespace recald::blind
