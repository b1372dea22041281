#include "core/assessment/given_data.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "core/absent.hpp"

namespace recald::assessment::given_data_test {
namespace {

// Two meters, four calibration months and two later ones; the second meter lacks a month.
constexpr int kMonths = 6;
constexpr int kSeen = 4;

calibration::ChainDraws draws_of(double discrepancy_sd, double error_sd, int count) {
  return {.theta = Eigen::MatrixXd::Constant(count, 1, 0.5),
          .discrepancy_precision =
              Eigen::VectorXd::Constant(count, 1.0 / (discrepancy_sd * discrepancy_sd)),
          .error_precision = Eigen::VectorXd::Constant(count, 1.0 / (error_sd * error_sd)),
          .beta = Eigen::MatrixXd::Constant(count, 2, 0.7),
          .log_density = Eigen::VectorXd::Zero(count),
          .acceptance_rate = 0.5};
}

AssessedCalibration two_meters(int draws) {
  AssessedCalibration result;
  for (int i = 0; i < kMonths; ++i) {
    result.month_names.push_back(std::to_string(i + 1));
    result.roles.push_back(i < kSeen ? MonthRole::calibration : MonthRole::validation);
    result.month_days.push_back(i % 2 == 0 ? 31.0 : 30.0);
  }
  result.parameters = {{"share", "-", {0.0, 0.5, 1.0}}};
  result.outputs.push_back({.name = "cold_daily_kWh",
                            .meter_id = "cold",
                            .unit = "kWh/day",
                            .measured = {110.0, 130.0, 170.0, 150.0, 140.0, 125.0},
                            .extra_variances = {0.0, 4.0, 0.0, 0.0, 0.0, 9.0}});
  result.outputs.push_back({.name = "heat_daily_kWh",
                            .meter_id = "heat",
                            .unit = "kWh/day",
                            .measured = {60.0, kAbsent, 20.0, 30.0, 45.0, 50.0}});
  calibration::Calibration& c = result.calibration;
  c.normalisation = {{{50.0, 250.0}, {0.0, 80.0}}, 0.05};
  c.hyper_prior = calibration::make_hyper_prior(calibration::HyperPriorProfile::scaled, 0.05);
  c.chains = {draws_of(0.06, 0.02, draws)};
  c.thinned = calibration::thin(c.chains, draws);
  return result;
}

WholePeriod whole_period() {
  Eigen::MatrixXd inputs(kMonths, 1);
  inputs << 0.0, 8.0, 20.0, 14.0, 10.0, 24.0;
  Eigen::VectorXd level = Eigen::VectorXd::Zero(2 * kMonths);
  level.head(kMonths).setConstant(12.0);
  return {{{"dry_bulb_C"}, inputs}, {level}};
}

/// What the model has at every draw.
Eigen::MatrixXd simulated(int draws) {
  Eigen::RowVectorXd row(2 * kMonths);
  row << 100.0, 120.0, 165.0, 140.0, 130.0, 170.0, 50.0, 40.0, 22.0, 28.0, 38.0, 18.0;
  return row.replicate(draws, 1);
}

/// Sigma of all twelve points in units, written out: eqs. (4) and (5) of the seed.
Eigen::MatrixXd covariance(const AssessedCalibration& result, const WholePeriod& whole) {
  const Eigen::VectorXd t = whole.inputs.values.col(0) / 20.0;  // by the range of the seen months
  const double ranges[] = {200.0, 80.0};
  Eigen::MatrixXd sigma(2 * kMonths, 2 * kMonths);
  for (int a = 0; a < 2 * kMonths; ++a) {
    for (int b = 0; b < 2 * kMonths; ++b) {
      const int output_a = a / kMonths;
      const int output_b = b / kMonths;
      const double distance = t(a % kMonths) - t(b % kMonths);
      double value = 0.06 * 0.06 *
                     std::exp(-0.7 * distance * distance - (output_a != output_b ? 0.7 : 0.0)) *
                     ranges[output_a] * ranges[output_b];
      value += whole.common_errors[0](a) * whole.common_errors[0](b);
      if (a == b) {
        value += 0.02 * 0.02 * ranges[output_a] * ranges[output_a];
        if (output_a == 0) value += result.outputs[0].extra_variances[static_cast<std::size_t>(a)];
      }
      sigma(a, b) = value;
    }
  }
  return sigma;
}

struct Normal {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// The points `asked` given the points `given`, from the covariance alone.
Normal by_hand(const AssessedCalibration& result, const WholePeriod& whole,
               const std::vector<int>& asked, const std::vector<int>& given) {
  const Eigen::MatrixXd sigma = covariance(result, whole);
  const Eigen::RowVectorXd model = simulated(1);
  Eigen::VectorXd residual(std::ssize(given));
  for (std::size_t i = 0; i < given.size(); ++i) {
    const auto p = static_cast<std::size_t>(given[i]);
    const double measured = result.outputs[p / kMonths].measured[p % kMonths];
    residual(static_cast<Eigen::Index>(i)) = measured - model(given[i]);
  }
  const Eigen::MatrixXd gain =
      Eigen::MatrixXd{sigma(asked, given)} * Eigen::MatrixXd{sigma(given, given)}.inverse();
  return {Eigen::VectorXd{model(asked).transpose()} + gain * residual,
          Eigen::MatrixXd{sigma(asked, asked)} - gain * Eigen::MatrixXd{sigma(given, asked)}};
}

const std::vector<int> kGiven{0, 1, 2, 3, 6, 8, 9};

TEST(GivenData, UnseenMonthsAreTheConditionalNormal) {
  const AssessedCalibration result = two_meters(1);
  const WholePeriod whole = whole_period();
  const auto forecasts = forecast_given_data(result, whole, simulated(1));
  ASSERT_TRUE(forecasts.has_value()) << forecasts.error().message;
  const std::vector<int> asked{4, 5, 7, 10, 11};
  const Normal expected = by_hand(result, whole, asked, kGiven);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const auto p = static_cast<std::size_t>(asked[i]);
    const auto& forecast = (*forecasts)[p / kMonths].months[p % kMonths];
    ASSERT_TRUE(forecast.has_value()) << p;
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(forecast->mean(), expected.mean(row), 1e-8) << p;
    EXPECT_NEAR(forecast->sd(), std::sqrt(expected.covariance(row, row)), 1e-8) << p;
  }
}

// Months share discrepancy and level, so their mean is less certain than independent ones would be.
TEST(GivenData, TheMeanOfUnseenMonthsKnowsThatTheyShareErrors) {
  const AssessedCalibration result = two_meters(1);
  const WholePeriod whole = whole_period();
  const auto forecasts = forecast_given_data(result, whole, simulated(1));
  const Normal expected = by_hand(result, whole, {4, 5}, kGiven);
  const Eigen::Vector2d days{31.0 / 61.0, 30.0 / 61.0};
  ASSERT_TRUE((*forecasts)[0].unseen_mean.has_value());
  EXPECT_NEAR((*forecasts)[0].unseen_mean->mean(), days.dot(expected.mean), 1e-8);
  EXPECT_NEAR((*forecasts)[0].unseen_mean->sd(), std::sqrt(days.dot(expected.covariance * days)),
              1e-8);
}

TEST(GivenData, ACalibrationMonthIsForecastFromTheOthers) {
  const AssessedCalibration result = two_meters(1);
  const WholePeriod whole = whole_period();
  const auto forecasts = forecast_given_data(result, whole, simulated(1));
  const Normal expected = by_hand(result, whole, {2, 8}, {0, 1, 3, 6, 9});
  EXPECT_NEAR((*forecasts)[0].months[2]->mean(), expected.mean(0), 1e-8);
  EXPECT_NEAR((*forecasts)[1].months[2]->mean(), expected.mean(1), 1e-8);
  EXPECT_NEAR((*forecasts)[1].months[2]->sd(), std::sqrt(expected.covariance(1, 1)), 1e-8);
  // In threes: the first three months from the fourth.
  const Normal block = by_hand(result, whole, {0, 1, 2, 6, 8}, {3, 9});
  EXPECT_NEAR((*forecasts)[0].blocks[1]->mean(), block.mean(1), 1e-8);
}

TEST(GivenData, NobodyLooksAtWhatIsForecast) {
  AssessedCalibration result = two_meters(1);
  const WholePeriod whole = whole_period();
  const auto before = forecast_given_data(result, whole, simulated(1));
  result.outputs[0].measured[5] *= 3.0;  // an unseen month
  result.outputs[0].measured[2] *= 3.0;  // and a seen one
  const auto after = forecast_given_data(result, whole, simulated(1));
  EXPECT_DOUBLE_EQ((*before)[0].months[2]->mean(), (*after)[0].months[2]->mean());
  EXPECT_NE((*before)[0].months[5]->mean(), (*after)[0].months[5]->mean());  // month 3 has changed
  result.outputs[0].measured[2] /= 3.0;
  const auto later_alone = forecast_given_data(result, whole, simulated(1));
  EXPECT_DOUBLE_EQ((*before)[0].months[5]->mean(), (*later_alone)[0].months[5]->mean());
}

// One of two draws fits the month that is left out far better; without that month both are alike.
TEST(GivenData, DrawsThatAMonthHasChosenCountLessWithoutIt) {
  const AssessedCalibration result = two_meters(40);
  const WholePeriod whole = whole_period();
  Eigen::MatrixXd model = simulated(40);
  for (int d = 0; d < 40; ++d) model(d, 2) += 0.5 * d;  // month 3 of the first meter
  const auto forecasts = forecast_given_data(result, whole, model);
  ASSERT_TRUE(forecasts.has_value()) << forecasts.error().message;
  const Eigen::VectorXd& weights = (*forecasts)[0].months[2]->weights;
  EXPECT_NEAR(weights.sum(), 1.0, 1e-12);
  // Draws near the measured value explain it best and so are weighed down.
  EXPECT_LT(weights(10), weights(39));
}

TEST(GivenData, AnOutputThatIsNotFittedIsFollowedByItsLevel) {
  AssessedCalibration result = two_meters(1);
  result.outputs[1].calibrated = false;
  result.calibration.chains[0].beta = Eigen::MatrixXd::Constant(1, 1, 0.7);  // one output is left
  const auto forecasts = forecast_given_data(result, whole_period(), simulated(1));
  ASSERT_TRUE(forecasts.has_value()) << forecasts.error().message;
  // Measured over modelled: 1.2, 0.91, 1.07 in the three seen months.
  const double level = (*forecasts)[1].months[4]->mean() / 38.0;
  EXPECT_GT(level, 1.0);
  EXPECT_LT(level, (60.0 / 50.0 + 20.0 / 22.0 + 30.0 / 28.0) / 3.0);  // drawn towards one
  ASSERT_TRUE((*forecasts)[1].unseen_mean.has_value());
  EXPECT_NEAR((*forecasts)[1].unseen_mean->mean(), level * (31.0 * 38.0 + 30.0 * 18.0) / 61.0,
              1e-9);
}

/// The second meter is not fitted, and followed by the model's errors. One output is left to the
/// draws.
AssessedCalibration one_fitted() {
  AssessedCalibration result = two_meters(1);
  result.outputs[1].calibrated = false;
  result.outputs[1].following = Following::errors;
  result.calibration.chains[0].beta = Eigen::MatrixXd::Constant(1, 1, 0.7);
  return result;
}

TEST(GivenData, AnOutputThatIsNotFittedMayBeFollowedByTheModelsErrors) {
  const AssessedCalibration result = one_fitted();
  const WholePeriod whole = whole_period();
  const auto forecasts = forecast_given_data(result, whole, simulated(1));
  ASSERT_TRUE(forecasts.has_value()) << forecasts.error().message;
  const Normal unseen = by_hand(result, whole, {10, 11}, {6, 8, 9});
  EXPECT_NEAR((*forecasts)[1].months[4]->mean(), unseen.mean(0), 1e-8);
  EXPECT_NEAR((*forecasts)[1].months[5]->sd(), std::sqrt(unseen.covariance(1, 1)), 1e-8);
  const Normal seen = by_hand(result, whole, {8}, {6, 9});
  EXPECT_NEAR((*forecasts)[1].months[2]->mean(), seen.mean(0), 1e-8);
}

// Its scale is none of the calibration's, which did not see it.
TEST(GivenData, WhatIsFollowedHasTheScaleOfItsDesignRuns) {
  AssessedCalibration result = one_fitted();
  result.calibration.normalisation.scales[1] = {0.0, 1.0};
  result.calibration.design.outputs.resize(2, 2 * kSeen);
  result.calibration.design.outputs << 1, 2, 3, 4, 30, 40, 50, 60,  //
      2, 3, 4, 5, 10, 20, 30, 90;
  scale_followed(result);
  EXPECT_EQ(result.calibration.normalisation.scales[0].max, 250.0);
  EXPECT_EQ(result.calibration.normalisation.scales[1].min, 10.0);
  EXPECT_EQ(result.calibration.normalisation.scales[1].max, 90.0);
  result.calibration.design.outputs.rightCols(kSeen).setConstant(7.0);
  scale_followed(result);
  EXPECT_EQ(result.outputs[1].following, Following::level);
}

// A fitted output is what it would be without it.
TEST(GivenData, WhatIsFollowedTellsNothingToTheOthers) {
  AssessedCalibration result = one_fitted();
  const WholePeriod whole = whole_period();
  const auto before = forecast_given_data(result, whole, simulated(1));
  result.outputs[1].measured[2] *= 2.0;
  const auto after = forecast_given_data(result, whole, simulated(1));
  for (std::size_t i = 0; i < kMonths; ++i) {
    EXPECT_DOUBLE_EQ((*before)[0].months[i]->mean(), (*after)[0].months[i]->mean()) << i;
  }
  EXPECT_NE((*before)[1].months[4]->mean(), (*after)[1].months[4]->mean());
}

}  // namespace
}  // namespace recald::assessment::given_data_test
