#include "core/assessment/fit_metrics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace recald::assessment::fit_metrics_test {
namespace {

using ::testing::HasSubstr;
const double kMissing = std::numeric_limits<double>::quiet_NaN();

// By hand: measured 100, 120, 80 (mean 100), simulated 110, 126, 78: differences s - m 10, 6, -2.
// NMBE = 14 / (2 * 100) = 0.07; CV(RMSE) = sqrt((100 + 36 + 4) / 2) / 100 = sqrt(70) / 100.
TEST(FitMetrics, HandCalculationWithBothSigns) {
  const auto fit =
      fit_metrics(std::vector<double>{100, 120, 80}, std::vector<double>{110, 126, 78});
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->nmbe_sim_minus_meas, 0.07, 1e-15);
  EXPECT_NEAR(fit->nmbe_g14, -0.07, 1e-15);
  EXPECT_NEAR(fit->cvrmse, std::sqrt(70.0) / 100.0, 1e-15);
  EXPECT_EQ(fit->n, 3);
}

TEST(FitMetrics, AModelThatIsTooHighHasAPositiveSimMinusMeas) {
  const auto fit = fit_metrics(std::vector<double>{10, 10}, std::vector<double>{11, 12});
  EXPECT_GT(fit->nmbe_sim_minus_meas, 0.0);
  EXPECT_LT(fit->nmbe_g14, 0.0);
}

TEST(FitMetrics, MissingMonthsAreSkippedWhateverTheModelSaysThere) {
  const auto fit = fit_metrics(std::vector<double>{100, kMissing, 120, 80, kMissing},
                               std::vector<double>{110, 1e9, 126, 78, kMissing});
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->nmbe_sim_minus_meas, 0.07, 1e-15);
  EXPECT_EQ(fit->n, 3);
}

TEST(FitMetrics, NeedsTwoMeasuredPoints) {
  for (const auto& measured : {std::vector<double>{}, {5.0}, {kMissing, 5.0, kMissing}}) {
    const auto fit = fit_metrics(measured, std::vector<double>(measured.size(), 5.0));
    ASSERT_FALSE(fit.has_value());
    EXPECT_EQ(fit.error().code, ErrorCode::not_enough_data);
  }
}

TEST(FitMetrics, RefusesASimulationThatIsNotFinite) {
  const auto fit = fit_metrics(std::vector<double>{1, 2, 3}, std::vector<double>{1, kMissing, 3});
  ASSERT_FALSE(fit.has_value());
  EXPECT_EQ(fit.error().code, ErrorCode::not_finite);
  EXPECT_THAT(fit.error().message, HasSubstr("point 2"));
}

TEST(FitMetrics, RefusesAMeanThatNothingCanBeRelativeTo) {
  for (const auto& measured : {std::vector<double>{0, 0}, {-5, 3}}) {
    const auto fit = fit_metrics(measured, std::vector<double>{1, 1});
    ASSERT_FALSE(fit.has_value());
    EXPECT_EQ(fit.error().code, ErrorCode::invalid_value);
  }
}

// ASHRAE Guideline 14: 5 % / 15 % monthly, 10 % / 30 % hourly.
TEST(Guideline14, JudgesBothFiguresAgainstTheLimitsOfTheGrain) {
  const FitMetrics at_the_limit{0.05, -0.05, 0.15, 24};
  EXPECT_TRUE(guideline14_verdict(at_the_limit).pass);

  const FitMetrics biased{-0.07, 0.07, 0.10, 24};
  const auto verdict = guideline14_verdict(biased);
  EXPECT_FALSE(verdict.pass);
  EXPECT_EQ(
      verdict.why,
      "|NMBE| is 7.0 %, above the limit of 5.0 % and CV(RMSE) is 10.0 % (limit 15.0 %), by the "
      "monthly tolerances of ASHRAE Guideline 14 on 24 points.");
  EXPECT_TRUE(guideline14_verdict(biased, kHourlyLimits).pass);

  const FitMetrics scattered{0.01, -0.01, 0.16, 24};
  EXPECT_FALSE(guideline14_verdict(scattered).pass);
  EXPECT_THAT(guideline14_verdict(scattered).why,
              HasSubstr("CV(RMSE) is 16.0 %, above the limit of 15.0 %"));
}

}  // namespace
}  // namespace recald::assessment::fit_metrics_test
