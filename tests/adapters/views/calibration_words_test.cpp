#include "adapters/views/calibration/calibration_words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace recald::views::calibration_words_test {
namespace {

using ::testing::HasSubstr;

FittedMeter meter(std::string label, double before, double after, double scatter = 0.08) {
  return {.label = std::move(label),
          .unseen = true,
          .before = before,
          .after = after,
          .scatter = scatter,
          .forecast = 0.007};
}

std::string sentence(const std::vector<FittedMeter>& meters) {
  return calibration_first_screen(meters, true).sentence;
}

TEST(CalibrationFirstSentence, SaysWhatCalibrationDidNotMend) {
  EXPECT_EQ(sentence({meter("Electricity", 0.01, 0.004), meter("Chilled water", -0.24, -0.22)}),
            "The model uses 22\u00a0% too little chilled water; calibration did not mend that: "
            "something is missing in it.");
}

TEST(CalibrationFirstSentence, SaysWhatItMendedInPart) {
  EXPECT_EQ(sentence({meter("Steam", 0.31, 0.07)}),
            "The model uses 7\u00a0% too much steam; calibration mended part of that, it was "
            "31\u00a0% off before.");
}

TEST(CalibrationFirstSentence, AFitMadeWorseComesFirst) {
  // Chilled water is further off, but it was before; steam has become worse.
  const auto first = calibration_first_screen(
      {meter("Chilled water", -0.24, -0.22), meter("Steam", 0.02, 0.11)}, true);
  EXPECT_EQ(first.sentence,
            "Calibration made the model worse: it now uses 11\u00a0% too much steam, and was "
            "2\u00a0% off before.");
  EXPECT_THAT(first.more, HasSubstr("savings computed from the model do not"));
}

TEST(CalibrationFirstSentence, RightSumsMayHideWrongMonths) {
  EXPECT_EQ(sentence({meter("Steam", 0.2, 0.01, 0.19), meter("Electricity", 0.1, 0.02)}),
            "The model uses the right amount of steam over the year, but its months are 19\u00a0% "
            "off.");
}

TEST(CalibrationFirstSentence, SaysThatItFits) {
  const auto first = calibration_first_screen(
      {meter("Steam", 0.2, -0.021), meter("Electricity", 0.1, 0.004)}, true);
  EXPECT_EQ(first.sentence, "The model uses what the meters show, to within 3\u00a0%.");
  EXPECT_EQ(first.more, "That holds in months that it was not fitted to.");
}

TEST(CalibrationFirstSentence, ChainsThatDidNotConvergeStandBeforeAll) {
  const auto first = calibration_first_screen({meter("Steam", 0.2, 0.004)}, false);
  EXPECT_EQ(first.sentence, "This calibration is rough: its chains have not converged.");
  EXPECT_THAT(first.more, HasSubstr("The model uses what the meter shows"));
}

TEST(CalibrationFirstSentence, AnAbbreviationKeepsItsLetters) {
  EXPECT_THAT(sentence({meter("PV", 0.3, 0.2)}), HasSubstr("too much PV;"));
}

TEST(CalibrationFirstNumbers, AreTheThreeLargestBiasesWithSigns) {
  const auto numbers =
      calibration_first_screen({meter("Electricity", 0.1, 0.004), meter("Steam", 0.2, 0.03),
                                meter("Chilled water", -0.24, -0.221), meter("Gas", 0.1, 0.01)},
                               true)
          .numbers;
  ASSERT_EQ(numbers.size(), 3u);
  EXPECT_EQ(numbers[0].number, "−22.1\u00a0%");
  EXPECT_EQ(numbers[1].number, "+3.0\u00a0%");
  EXPECT_EQ(numbers[2].what, "Gas, model against meter in months that were not fitted");
}

TEST(CalibrationFirstNumbers, OfOneMeterAreModelForecastAndBefore) {
  const auto numbers = calibration_first_screen({meter("Steam", 0.31, -0.02)}, true).numbers;
  ASSERT_EQ(numbers.size(), 3u);
  EXPECT_EQ(numbers[0].number, "−2.0\u00a0%");
  EXPECT_EQ(numbers[1].number, "+0.7\u00a0%");
  EXPECT_EQ(numbers[2].number, "+31.0\u00a0%");
}

TEST(FittedMeterOf, TakesUnseenMonthsWhereThereAreAny) {
  assessment::OutputAssessment fit;
  fit.after.calibration = {0.01, -0.01, 0.05, 24};
  EXPECT_FALSE(fitted_meter("Steam", fit)->unseen);
  EXPECT_EQ(fitted_meter("Steam", fit)->after, 0.01);
  EXPECT_TRUE(std::isnan(fitted_meter("Steam", fit)->before));
  fit.after.validation = {0.04, -0.04, 0.07, 12};
  fit.before.validation = {0.2, -0.2, 0.25, 12};
  EXPECT_TRUE(fitted_meter("Steam", fit)->unseen);
  EXPECT_EQ(fitted_meter("Steam", fit)->after, 0.04);
  EXPECT_EQ(fitted_meter("Steam", fit)->before, 0.2);
  EXPECT_FALSE(fitted_meter("Steam", assessment::OutputAssessment{}));
}

}  // namespace
}  // namespace recald::views::calibration_words_test
