#include "core/assessment/output_assessment.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/absent.hpp"

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

OutputAssessment assess(const std::array<double, 6>& measured = kMeasured) {
  return assess_output(measured, kRoles,
                       {.prior_mode = kHigh,
                        .prior_mean = kExact,
                        .posterior_mean = kExact,
                        .draws = five_draws(),
                        .predictive = five_draws()});
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

// Quartiles lie 1 kWh, the 5 % and 95 % quantiles 1.8 kWh from the middle draw.
TEST(AssessOutput, CountsMonthsInsideThePredictiveIntervals) {
  const auto scores = assess({10.9, 21.7, kAbsent, 27.9, 40.0, 99.0});
  ASSERT_TRUE(scores.scores_calibration && scores.scores_validation);
  EXPECT_EQ(scores.scores_calibration->months, 2);
  EXPECT_EQ(scores.scores_calibration->inside_50, 1);
  EXPECT_EQ(scores.scores_calibration->inside_90, 2);
  EXPECT_EQ(scores.scores_validation->months, 2);
  EXPECT_EQ(scores.scores_validation->inside_50, 1);
  EXPECT_EQ(scores.scores_validation->inside_90, 1);
}

// Against the middle draw: (2 + 1 + 0 + 1 + 2) / 5 − 40 / 25 / 2 = 0.4, in both months.
TEST(AssessOutput, ScoresAreMeansOverTheMonths) {
  EXPECT_NEAR(assess().scores_calibration->crps, 0.4, 1e-12);
}

TEST(AssessOutput, PeriodWithoutAMeasuredMonthHasNoScores) {
  const auto assessment = assess({10.0, 20.0, kAbsent, kAbsent, kAbsent, 99.0});
  EXPECT_TRUE(assessment.scores_calibration);
  EXPECT_FALSE(assessment.scores_validation);
}

TEST(AddDiscrepancyAndError, AddsNothingWhereNothingIsUncertain) {
  Rng rng{1};
  const Eigen::MatrixXd draws = five_draws();
  EXPECT_EQ(add_discrepancy_and_error(draws, Eigen::VectorXd::Zero(5), {}, rng), draws);
}

// Variances add: sd 3 alone, with a known variance of 16 on top it is 5. The bound is four standard
// errors of a standard deviation, sd / √(2 n).
TEST(AddDiscrepancyAndError, SpreadsByTheSumOfVariances) {
  constexpr int kDraws = 20'000;
  Rng rng{5};
  const Eigen::MatrixXd draws = Eigen::MatrixXd::Constant(kDraws, 2, 100.0);
  const std::array extra = {0.0, 16.0};
  const Eigen::MatrixXd spread =
      add_discrepancy_and_error(draws, Eigen::VectorXd::Constant(kDraws, 3.0), extra, rng);
  const Eigen::VectorXd first = spread.col(0).array() - spread.col(0).mean();
  const Eigen::VectorXd second = spread.col(1).array() - spread.col(1).mean();
  const double sd_first = std::sqrt(first.squaredNorm() / kDraws);
  const double sd_second = std::sqrt(second.squaredNorm() / kDraws);
  EXPECT_NEAR(sd_first, 3.0, 4.0 * 3.0 / std::sqrt(2.0 * kDraws));
  EXPECT_NEAR(sd_second, 5.0, 4.0 * 5.0 / std::sqrt(2.0 * kDraws));
  EXPECT_NEAR(spread.col(0).mean(), 100.0, 4.0 * 3.0 / std::sqrt(kDraws));
  // Months are independent.
  EXPECT_NEAR(first.dot(second) / kDraws / (sd_first * sd_second), 0.0, 4.0 / std::sqrt(kDraws));
}

TEST(AddDiscrepancyAndError, EachDrawHasItsOwnSpread) {
  Rng rng{5};
  Eigen::VectorXd sd(2);
  sd << 0.0, 10.0;
  const Eigen::MatrixXd spread =
      add_discrepancy_and_error(Eigen::MatrixXd::Zero(2, 50), sd, {}, rng);
  EXPECT_EQ(spread.row(0).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_GT(spread.row(1).cwiseAbs().minCoeff(), 0.0);
}

TEST(AddDiscrepancyAndError, SameSeedSameNumbers) {
  Rng one{9};
  Rng other{9};
  const Eigen::VectorXd sd = Eigen::VectorXd::Constant(5, 2.0);
  EXPECT_EQ(add_discrepancy_and_error(five_draws(), sd, {}, one),
            add_discrepancy_and_error(five_draws(), sd, {}, other));
}

}  // namespace
}  // namespace recald::assessment::output_assessment_test
