#include "tests/blind/scoring/calibration_scores.hpp"

#include <gtest/gtest.h>

#include "tests/blind/scoring/made_up.hpp"
#include "tests/blind/scoring/scores.hpp"

namespace recald::blind {
namespace {

using made_up::effect;
using made_up::said;

CaseResult calibrated(const std::string& case_id, std::map<std::string, CalibrationFit> fits) {
  CaseResult result = said(case_id, Outcome::none, {}, std::string(kCalibrate));
  result.calibration = std::move(fits);
  return result;
}

TEST(CalibrationScores, MedianOverTheMetersOfCasesThatHideNothing) {
  made_up::Population population;
  population.add(made_up::nothing_hidden("a"), said("a", Outcome::none));
  population.add(made_up::nothing_hidden("b"), said("b", Outcome::none));
  population.add(made_up::single("c", effect("A")), said("c", Outcome::none));
  population.add(calibrated(
      "a", {{"electricity", {.before = 0.10, .after = 0.05, .forecast = 0.04, .yardstick = 0.06}},
            {"gas", {.before = 0.20, .after = 0.30, .forecast = 0.20, .yardstick = 0.10}}}));
  population.add(calibrated(
      "b",
      {{"electricity", {.before = 0.12, .after = 0.06, .forecast = 0.05, .yardstick = 0.07}}}));
  population.add(calibrated(
      "c", {{"electricity", {.before = 0.90, .after = 0.95, .forecast = 0.9, .yardstick = 0.1}}}));
  const CalibrationScores scores =
      calibration_scores(population.cases(), calibrations_of(population.results()));
  EXPECT_DOUBLE_EQ(scores.before->value, 0.12);
  EXPECT_DOUBLE_EQ(scores.after->value, 0.06);
  EXPECT_DOUBLE_EQ(scores.forecast->value, 0.05);
  EXPECT_DOUBLE_EQ(scores.yardstick->value, 0.07);
  EXPECT_EQ(scores.harmed->hits, 1);
  EXPECT_EQ(scores.harmed->cases, 3);
  EXPECT_EQ(scores.beaten->hits, 1);
}

TEST(CalibrationScores, AreNoMethodThatNamesAnything) {
  made_up::Population population;
  population.add(made_up::nothing_hidden("a"), said("a", Outcome::none));
  population.add(calibrated("a", {}));
  const Scores scores = compute_scores(population.key(), population.results(), {}, {});
  EXPECT_EQ(scores.methods.size(), 1u);
  EXPECT_TRUE(missing_cases(population.key(), population.results(), "recald").empty());
  EXPECT_FALSE(scores.worlds.at(0).calibration.before);
}

}  // namespace
}  // namespace recald::blind
