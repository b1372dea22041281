#include "core/savings/drawn_errors.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace recald::savings::drawn_errors_test {
namespace {

using assessment::CommonError;

constexpr int kMonths = 12;
constexpr int kDraws = 4000;
constexpr double kErrorSd = 0.02;  // of the normalised scale
constexpr double kLevelSd = 0.2;
constexpr double kSlope = 8.0;  // kWh/day per unit of theta, times the month's input

/// f = theta * slope * x + base, of one meter whose real level is 1.3 and whose theta is 0.5.
struct Site {
  calibration::CalibrationProblem problem;
  calibration::Calibration calibration;
  std::vector<CommonError> errors;
  Eigen::MatrixXd simulated;
  Eigen::VectorXd level_error;
};

Site site_of_level(double level) {
  Site site;
  Eigen::VectorXd x(kMonths);
  for (int i = 0; i < kMonths; ++i) x(i) = 1.0 + std::cos(0.5 * i);
  Eigen::VectorXd model = Eigen::VectorXd::Constant(kMonths, 60.0) + 0.5 * kSlope * x;
  site.problem.parameters = {{"share", "-", {0.0, 0.5, 1.0}}};
  calibration::OutputMeasurements output{
      .name = "cold_daily_kWh", .unit = "kWh/day", .values = {}, .extra_variances = {}};
  for (int i = 0; i < kMonths; ++i) {
    site.problem.month_names.push_back(std::to_string(i + 1));
    output.values.push_back(level * model(i));
  }
  site.problem.outputs = {output};
  site.problem.inputs = {{"dry_bulb_C"}, x};
  site.level_error = kLevelSd * model;
  site.problem.common_errors = {site.level_error};
  site.errors = {{CommonError::Kind::level, 0, kLevelSd}};
  calibration::Calibration& c = site.calibration;
  c.normalisation = {{{0.0, 100.0}}, 0.05};
  c.hyper_prior = calibration::make_hyper_prior(calibration::HyperPriorProfile::scaled, 0.05);
  c.chains = {{.theta = Eigen::MatrixXd::Constant(kDraws, 1, 0.5),
               .discrepancy_precision = Eigen::VectorXd::Constant(kDraws, 1e8),
               .error_precision = Eigen::VectorXd::Constant(kDraws, 1.0 / (kErrorSd * kErrorSd)),
               .beta = Eigen::MatrixXd::Constant(kDraws, 1, 0.7),
               .log_density = Eigen::VectorXd::Zero(kDraws),
               .acceptance_rate = 0.5}};
  site.simulated = model.transpose().replicate(kDraws, 1);
  return site;
}

Result<DrawnErrors> drawn(const Site& site, Limits limits) {
  Rng rng{7};
  return draw_errors(site.problem, site.errors, site.calibration,
                     calibration::thin(site.calibration.chains, kDraws), site.simulated,
                     std::array{limits}, rng);
}

// One direction of error and independent noise: the posterior of its coefficient is that of a
// regression on it with a standard normal prior.
TEST(DrawnErrors, LevelsAreThePosteriorOfARegression) {
  const Site site = site_of_level(1.3);
  const auto errors = drawn(site, {0.0, 1.0});
  ASSERT_TRUE(errors.has_value()) << errors.error().message;
  const double noise = 100.0 * kErrorSd;
  const double precision = 1.0 + site.level_error.squaredNorm() / (noise * noise);
  const Eigen::VectorXd residual = 0.3 / kLevelSd * site.level_error;
  const double mean = site.level_error.dot(residual) / (noise * noise) / precision;
  const double sd = kLevelSd / std::sqrt(precision);
  const Eigen::ArrayXd level = errors->level.col(0).array();
  // Five standard errors.
  EXPECT_NEAR(level.mean(), 1.0 + kLevelSd * mean, 5.0 * sd / std::sqrt(kDraws));
  EXPECT_NEAR(std::sqrt((level - level.mean()).square().mean()), sd, 0.1 * sd);
  EXPECT_TRUE((errors->theta.array() == 0.5).all());
}

TEST(DrawnErrors, AParametersMeaningMovesWithinItsLimits) {
  Site site = site_of_level(1.3);
  site.errors = {{CommonError::Kind::parameter, 0, 0.4}};
  const auto errors = drawn(site, {0.0, 0.8});
  ASSERT_TRUE(errors.has_value()) << errors.error().message;
  EXPECT_TRUE((errors->level.array() == 1.0).all());
  EXPECT_DOUBLE_EQ(errors->theta.maxCoeff(), 0.8);  // 0.5 + 0.4 * 1.5 is beyond
}

TEST(DrawnErrors, AMeterThatIsNotFittedKeepsItsPriorLevel) {
  Site site = site_of_level(1.3);
  site.problem.outputs.push_back({.name = "peak",
                                  .unit = "kW",
                                  .values = std::vector<double>(kMonths, std::nan("")),
                                  .extra_variances = {}});
  site.calibration.normalisation.scales.push_back({0.0, 1.0});
  Eigen::VectorXd of_first = Eigen::VectorXd::Zero(2 * kMonths);
  of_first.head(kMonths) = site.level_error;
  Eigen::VectorXd of_second = Eigen::VectorXd::Zero(2 * kMonths);
  of_second.tail(kMonths).setConstant(1.0);
  site.problem.common_errors = {of_first, of_second};
  site.errors.push_back({CommonError::Kind::level, 1, 0.1});
  site.simulated.conservativeResize(kDraws, 2 * kMonths);
  site.simulated.rightCols(kMonths).setConstant(10.0);
  const auto errors = drawn(site, {0.0, 1.0});
  ASSERT_TRUE(errors.has_value()) << errors.error().message;
  const Eigen::ArrayXd level = errors->level.col(1).array();
  EXPECT_NEAR(level.mean(), 1.0, 5.0 * 0.1 / std::sqrt(kDraws));
  EXPECT_NEAR(std::sqrt((level - level.mean()).square().mean()), 0.1, 0.01);
}

TEST(DrawnErrors, AModelThatGivesNoNumberIsAnError) {
  Site site = site_of_level(1.0);
  site.simulated(3, 2) = std::nan("");
  const auto errors = drawn(site, {0.0, 1.0});
  ASSERT_FALSE(errors.has_value());
  EXPECT_EQ(errors.error().code, ErrorCode::not_finite);
}

TEST(DrawnErrors, ResponsesHaveTheMedianOne) {
  Rng rng{3};
  const Eigen::MatrixXd factors =
      draw_responses(kDraws, std::array{assessment::Service::cooling}, {0.1, 0.2, 0.3}, rng);
  const Eigen::ArrayXd logs = factors.array().log();
  EXPECT_NEAR(logs.mean(), 0.0, 5.0 * 0.2 / std::sqrt(kDraws));
  EXPECT_NEAR(std::sqrt(logs.square().mean()), 0.2, 0.02);
}

}  // namespace
}  // namespace recald::savings::drawn_errors_test
