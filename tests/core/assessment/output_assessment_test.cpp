#include "core/assessment/output_assessment.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/absent.hpp"
#include "core/assessment/given_data.hpp"

namespace recald::assessment::output_assessment_test {
namespace {

constexpr auto kFit = MonthRole::calibration;
constexpr auto kCheck = MonthRole::validation;

// Three calibration months, one of them not measured; two validation months; one shown only.
constexpr std::array kRoles = {kFit, kFit, kFit, kCheck, kCheck, MonthRole::unused};
constexpr std::array kMeasured = {10.0, 20.0, kAbsent, 30.0, 40.0, 99.0};
constexpr std::array kHigh = {11.0, 22.0, 5.0, 33.0, 44.0, 1.0};
constexpr std::array kExact = {10.0, 20.0, 5.0, 30.0, 40.0, 1.0};

/// Five draws that stand -2, -1, 0, 1, 2 kWh beside the exact months.
Eigen::MatrixXd five_draws() {
  Eigen::MatrixXd draws(5, 6);
  for (int d = 0; d < 5; ++d) {
    for (int i = 0; i < 6; ++i) draws(d, i) = kExact[static_cast<std::size_t>(i)] + d - 2;
  }
  return draws;
}

Forecast normal(double mean, double sd) {
  return {Eigen::VectorXd::Constant(1, mean), Eigen::VectorXd::Constant(1, sd),
          Eigen::VectorXd::Ones(1)};
}

/// Exact in the middle, sd 1 kWh; in blocks 2 kWh too high.
OutputForecasts forecasts() {
  OutputForecasts all;
  for (std::size_t i = 0; i < 6; ++i) {
    all.months.emplace_back(normal(kExact[i], 1.0));
    all.blocks.emplace_back();
    if (i < 3) all.blocks.back() = normal(kExact[i] + 2.0, 1.0);
  }
  all.unseen_mean = normal(35.0, 0.8);
  all.unreliable_months = 1;
  return all;
}

OutputAssessment assess(const std::array<double, 6>& measured = kMeasured) {
  return assess_output(
      measured, kRoles,
      {.prior_mode = kHigh, .prior_mean = kExact, .posterior_mean = kExact, .draws = five_draws()},
      forecasts(), {});
}

// n = 2, mean 15, excess 1 + 2, p = 1: NMBE 3 / 15, CV(RMSE) √5 / 15; likewise 7 / 35 and 5 / 35.
TEST(AssessOutput, JudgesEachPeriodOnItsOwnMeasuredMonths) {
  const PeriodMetrics before = assess().before;
  ASSERT_TRUE(before.calibration && before.validation);
  EXPECT_EQ(before.calibration->n, 2);
  EXPECT_NEAR(before.calibration->nmbe_sim_minus_meas, 0.2, 1e-12);
  EXPECT_NEAR(before.calibration->cvrmse, std::sqrt(5.0) / 15.0, 1e-12);
  EXPECT_EQ(before.validation->n, 2);
  EXPECT_NEAR(before.validation->nmbe_sim_minus_meas, 0.2, 1e-12);
  EXPECT_NEAR(before.validation->cvrmse, 5.0 / 35.0, 1e-12);
}

TEST(AssessOutput, EachStageHasItsOwnSimulation) {
  const OutputAssessment assessment = assess();
  EXPECT_NEAR(assessment.prior_mean.calibration->cvrmse, 0.0, 1e-12);
  EXPECT_NEAR(assessment.after.validation->cvrmse, 0.0, 1e-12);
  EXPECT_GT(assessment.before.validation->cvrmse, 0.1);
}

TEST(AssessOutput, PeriodWithOneMeasuredMonthHasNoMetrics) {
  std::array<double, 6> measured = kMeasured;
  measured[3] = kAbsent;
  const OutputAssessment assessment = assess(measured);
  EXPECT_TRUE(assessment.before.calibration);
  EXPECT_FALSE(assessment.before.validation);
  EXPECT_TRUE(assessment.draw_cvrmse_validation.empty());
}

TEST(AssessOutput, EveryMonthHasABoxMeasuredOrNot) {
  const OutputAssessment assessment = assess();
  ASSERT_EQ(assessment.boxes.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_DOUBLE_EQ(assessment.boxes[i].q50, kExact[i]);
    EXPECT_DOUBLE_EQ(assessment.boxes[i].q25, kExact[i] - 1.0);
    EXPECT_DOUBLE_EQ(assessment.boxes[i].high_whisker, kExact[i] + 2.0);
  }
}

// A draw that is d kWh off in both months: CV(RMSE) = √(2 d²) / mean.
TEST(AssessOutput, EveryDrawHasItsScatter) {
  const OutputAssessment assessment = assess();
  ASSERT_EQ(assessment.draw_cvrmse_calibration.size(), 5u);
  EXPECT_NEAR(assessment.draw_cvrmse_calibration[0], 2.0 * std::sqrt(2.0) / 15.0, 1e-12);
  EXPECT_NEAR(assessment.draw_cvrmse_calibration[2], 0.0, 1e-12);
  ASSERT_EQ(assessment.draw_cvrmse_validation.size(), 5u);
  EXPECT_NEAR(assessment.draw_cvrmse_validation[4], 2.0 * std::sqrt(2.0) / 35.0, 1e-12);
}

// Quartiles lie 0.67 kWh, the 5 % and 95 % quantiles 1.64 kWh from the middle.
TEST(AssessOutput, CountsMonthsInsideTheForecastsIntervals) {
  const ForecastAssessment forecast = assess({10.6, 21.5, kAbsent, 27.9, 40.0, 99.0}).forecast;
  ASSERT_TRUE(forecast.calibration.scores && forecast.validation.scores);
  EXPECT_EQ(forecast.calibration.scores->months, 2);
  EXPECT_EQ(forecast.calibration.scores->inside_50, 1);
  EXPECT_EQ(forecast.calibration.scores->inside_90, 2);
  EXPECT_EQ(forecast.validation.scores->months, 2);
  EXPECT_EQ(forecast.validation.scores->inside_50, 1);
  EXPECT_EQ(forecast.validation.scores->inside_90, 1);
}

// A month in the middle: CRPS 0.2337 sd (Gneiting, Raftery 2007, eq. 20), width of 90 % 3.2897 sd.
TEST(AssessOutput, ScoresAreMeansOverTheMonths) {
  const ForecastFit fit = assess().forecast.validation;
  EXPECT_NEAR(fit.scores->crps, 0.23370, 1e-5);
  EXPECT_NEAR(fit.scores->interval_score_90, 3.28971, 1e-5);
  EXPECT_NEAR(fit.metrics->cvrmse, 0.0, 1e-12);
}

TEST(AssessOutput, BlocksAreJudgedOnCalibrationMonths) {
  const ForecastFit fit = assess().forecast.blocks;
  ASSERT_TRUE(fit.metrics && fit.scores);
  EXPECT_EQ(fit.scores->months, 2);
  EXPECT_NEAR(fit.metrics->nmbe_sim_minus_meas, 4.0 / 15.0, 1e-12);  // 2 + 2 over (n - 1) mean
  EXPECT_EQ(fit.scores->inside_90, 0);
}

TEST(AssessOutput, TheMeanOfUnseenMonthsIsOfThoseMeasured) {
  const auto& unseen = assess().forecast.unseen_mean;
  ASSERT_TRUE(unseen.has_value());
  EXPECT_DOUBLE_EQ(unseen->measured, 35.0);
  EXPECT_NEAR(unseen->forecast.q95, 35.0 + 0.8 * 1.644854, 1e-5);
}

TEST(AssessOutput, PeriodWithoutAMeasuredMonthHasNoScores) {
  const auto assessment = assess({10.0, 20.0, kAbsent, kAbsent, kAbsent, 99.0});
  EXPECT_TRUE(assessment.forecast.calibration.scores);
  EXPECT_FALSE(assessment.forecast.validation.scores);
}

}  // namespace
}  // namespace recald::assessment::output_assessment_test
