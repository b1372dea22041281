#include "core/calibration/posterior/posterior.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>
#include <vector>

#include "tests/core/calibration/toy_models.hpp"

namespace recald::calibration::posterior_test {
namespace {

using ::testing::HasSubstr;

const HyperPrior kPrior{"test", {10.0, 0.02}, {10.0, 0.002}, {1.0, 0.3}};

/// Outputs that do not depend on the one parameter and are zero: the residual is the measurement.
FunctionModel zero_model(int outputs, int months) {
  return {1, outputs, months, [](std::span<const double>, std::span<double> values) {
            std::fill(values.begin(), values.end(), 0.0);
          }};
}

std::vector<Parameter> one_parameter() { return {{"unused", "-", {0.0, 0.5, 1.0}}}; }

/// Three points at scaled inputs (0, 0), (0.5, 0), (0.5, 1), the second being the output type.
PosteriorData three_points() {
  PosteriorData data;
  data.points = {{0, 0}, {0, 1}, {1, 1}};
  data.values = Eigen::Vector3d(0.05, -0.02, 0.03);
  data.extra_variances = Eigen::Vector3d::Zero();
  data.month_inputs = Eigen::Vector2d(0.0, 0.5);
  data.scales = {{0.0, 1.0}, {0.0, 1.0}};
  data.weights = {1.0, 1.0};
  return data;
}

const Hyperparameters kThreePointHyper{400.0, 4000.0, Eigen::Vector2d(1.0, 0.5)};

double log_likelihood(Posterior& posterior, const Hyperparameters& hyper,
                      const std::vector<double>& theta) {
  EXPECT_TRUE(posterior.set_hyperparameters(hyper));
  return posterior.log_likelihood(theta).value();
}

// Worked by hand: Sigma has 0.002750 on the diagonal and 0.00194700, 0.00118092, 0.00151633 beside
// it; r' Sigma^-1 r = 3.827221, log|Sigma| = -18.750996.
TEST(Posterior, LikelihoodOfThreePoints) {
  auto posterior = Posterior::make(zero_model(2, 2), one_parameter(), three_points(), kPrior);
  ASSERT_TRUE(posterior.has_value());

  EXPECT_NEAR(log_likelihood(*posterior, kThreePointHyper, {0.5}), 4.705072, 5e-7);
}

TEST(Posterior, WeightOfHalfOnTheThirdPoint) {
  PosteriorData data = three_points();
  data.weights = {1.0, 0.5};
  data.weight_reference = kThreePointHyper;
  auto posterior = Posterior::make(zero_model(2, 2), one_parameter(), data, kPrior);
  ASSERT_TRUE(posterior.has_value());

  EXPECT_NEAR(log_likelihood(*posterior, kThreePointHyper, {0.5}), 4.459361, 5e-7);
}

// ---- against a covariance written out element by element and a full-pivoting inverse ----

/// Known errors beside the discrepancy: of each point, or of each month and common to all points.
enum class Extras { none, by_point, by_month };

struct Case {
  const char* name;
  int outputs;
  int months;
  bool missing;
  Extras extras;
  friend void PrintTo(const Case& which, std::ostream* out) { *out << which.name; }
};

PosteriorData random_data(const Case& c, Rng& rng) {
  PosteriorData data;
  data.month_inputs.resize(c.months, 3);
  for (double& x : data.month_inputs.reshaped()) x = rng.uniform();
  for (int k = 0; k < c.outputs; ++k) {
    for (int i = 0; i < c.months; ++i) {
      if (!c.missing || rng.uniform() < 0.7) data.points.push_back({k, i});
    }
    data.scales.push_back({1.0 + k, 3.0 + 2.0 * k});
    data.weights.push_back(c.extras == Extras::by_point && k > 0 ? 0.4 : 1.0);
  }
  const auto m = static_cast<Eigen::Index>(data.points.size());
  data.values.resize(m);
  for (double& y : data.values) y = rng.uniform(-0.1, 1.1);
  data.extra_variances.setZero(m);
  data.common_errors.resize(m, c.extras == Extras::none ? 0 : 2);
  if (c.extras != Extras::none) {
    for (double& v : data.extra_variances) v = 0.01 * rng.uniform();
    for (double& g : data.common_errors.reshaped()) g = 0.1 * rng.normal();
  }
  if (c.extras == Extras::by_month) {
    for (Eigen::Index i = c.months; i < m; ++i) {
      data.extra_variances(i) = data.extra_variances(i - c.months);
    }
  }
  return data;
}

Hyperparameters random_hyper(Eigen::Index dimension, Rng& rng) {
  Hyperparameters hyper{rng.uniform(20.0, 1000.0), rng.uniform(200.0, 5000.0), {}};
  hyper.beta.resize(dimension);
  for (double& b : hyper.beta) b = rng.uniform(0.0, 3.0);
  return hyper;
}

Eigen::MatrixXd covariance_by_definition(const PosteriorData& data, const Hyperparameters& hyper) {
  const auto m = static_cast<Eigen::Index>(data.points.size());
  Eigen::MatrixXd sigma(m, m);
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index j = 0; j < m; ++j) {
      const PointIndex& a = data.points[static_cast<std::size_t>(i)];
      const PointIndex& b = data.points[static_cast<std::size_t>(j)];
      double exponent = a.output == b.output || hyper.beta.size() == 3 ? 0.0 : hyper.beta(3);
      for (Eigen::Index s = 0; s < 3; ++s) {
        exponent += hyper.beta(s) *
                    std::pow(data.month_inputs(a.month, s) - data.month_inputs(b.month, s), 2);
      }
      sigma(i, j) = std::exp(-exponent) / hyper.discrepancy_precision;
      for (Eigen::Index g = 0; g < data.common_errors.cols(); ++g) {
        sigma(i, j) += data.common_errors(i, g) * data.common_errors(j, g);
      }
    }
    sigma(i, i) += 1.0 / hyper.error_precision + data.extra_variances(i);
  }
  return sigma;
}

void add_weights_by_definition(const PosteriorData& data, const Hyperparameters& reference,
                               Eigen::MatrixXd& sigma) {
  const Eigen::MatrixXd at_reference = covariance_by_definition(data, reference);
  for (Eigen::Index i = 0; i < sigma.rows(); ++i) {
    for (Eigen::Index j = 0; j < sigma.cols(); ++j) {
      const int output = data.points[static_cast<std::size_t>(i)].output;
      if (output != data.points[static_cast<std::size_t>(j)].output) continue;
      const double weight = data.weights[static_cast<std::size_t>(output)];
      sigma(i, j) += (1.0 / weight - 1.0) * at_reference(i, j);
    }
  }
}

double log_normal_density(const Eigen::VectorXd& residual, const Eigen::MatrixXd& sigma) {
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(sigma);
  const double quadratic = residual.dot(lu.solve(residual));
  return -0.5 * (quadratic + std::log(lu.determinant()) +
                 static_cast<double>(residual.size()) * std::log(2.0 * std::numbers::pi));
}

class LikelihoodByBruteForce : public ::testing::TestWithParam<Case> {};

TEST_P(LikelihoodByBruteForce, AgreesTo1e9) {
  const Case c = GetParam();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Rng rng(seed);
    PosteriorData data = random_data(c, rng);
    data.weight_reference = random_hyper(c.outputs > 1 ? 4 : 3, rng);
    const FunctionModel model(1, c.outputs, c.months,
                              [](std::span<const double> theta, std::span<double> values) {
                                for (std::size_t i = 0; i < values.size(); ++i) {
                                  values[i] = 1.0 + theta[0] + 0.1 * static_cast<double>(i % 7);
                                }
                              });
    auto posterior = Posterior::make(model, one_parameter(), data, kPrior);
    ASSERT_TRUE(posterior.has_value());
    for (int repeat = 0; repeat < 3; ++repeat) {
      const Hyperparameters hyper = random_hyper(posterior->kernel_dimension(), rng);
      const double theta = rng.uniform();
      Eigen::VectorXd residual = data.values;
      for (Eigen::Index i = 0; i < residual.size(); ++i) {
        const PointIndex& p = data.points[static_cast<std::size_t>(i)];
        const double output = 1.0 + theta + 0.1 * ((p.output * c.months + p.month) % 7);
        residual(i) -= data.scales[static_cast<std::size_t>(p.output)].normalise(output);
      }
      Eigen::MatrixXd sigma = covariance_by_definition(data, hyper);
      add_weights_by_definition(data, *data.weight_reference, sigma);
      const double expected = log_normal_density(residual, sigma);

      EXPECT_NEAR(log_likelihood(*posterior, hyper, {theta}), expected,
                  1e-9 * std::max(1.0, std::abs(expected)));
      EXPECT_EQ(posterior->jitter_count(), 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, LikelihoodByBruteForce,
    ::testing::Values(Case{"one_output", 1, 12, false, Extras::none},
                      Case{"two_outputs", 2, 24, false, Extras::none},
                      Case{"two_outputs_missing_months", 2, 24, true, Extras::none},
                      Case{"three_outputs", 3, 12, false, Extras::none},
                      Case{"three_outputs_missing_months", 3, 12, true, Extras::none},
                      Case{"three_outputs_errors_by_point", 3, 12, true, Extras::by_point},
                      Case{"one_output_errors_by_point", 1, 12, true, Extras::by_point},
                      Case{"one_output_errors_by_month", 1, 12, false, Extras::by_month},
                      Case{"three_outputs_errors_by_month", 3, 12, false, Extras::by_month}),
    [](const auto& given) { return given.param.name; });

// ---- the unconstrained density ----

PosteriorData toy_data(double second_weight = 1.0) {
  const CalibrationProblem problem = toy_problem(2, 12);
  PosteriorData data =
      normalise_problem(problem, {{{400.0, 2500.0}, {900.0, 5000.0}}, /*pooled_variance=*/0.05});
  data.weights[1] = second_weight;
  return data;
}

// Log densities in the two coordinate systems differ by the log Jacobian of the map between them.
TEST(Posterior, UnconstrainedDensityCarriesTheJacobian) {
  auto posterior = Posterior::make(toy_model(2, 12), toy_parameters(), toy_data(), kPrior);
  ASSERT_TRUE(posterior.has_value());
  Rng rng(5);
  for (int repeat = 0; repeat < 50; ++repeat) {
    const Eigen::VectorXd point = posterior->draw_start(rng);
    Eigen::VectorXd theta(2);
    Hyperparameters hyper{0.0, 0.0, Eigen::VectorXd(3)};
    posterior->to_natural(point, theta, hyper);
    double log_jacobian = point(2) + point(3);
    for (Eigen::Index j = 0; j < 2; ++j) {
      const double density = toy_parameters()[static_cast<std::size_t>(j)].prior.density(theta(j));
      log_jacobian +=
          -0.5 * point(j) * point(j) - 0.5 * std::log(2.0 * std::numbers::pi) - std::log(density);
    }
    for (Eigen::Index s = 0; s < 3; ++s) {
      // rho = exp(-beta / 4), whose slope is -rho / 4 times that of beta: near 1 only beta has
      // digits left to take a difference of.
      constexpr double h = 1e-5;
      const auto beta = [&](double score) { return kPrior.rho.at_score(score).beta; };
      const double slope = (beta(point(4 + s) + h) - beta(point(4 + s) - h)) / (2.0 * h);
      log_jacobian += -0.25 * beta(point(4 + s)) + std::log(-0.25 * slope);
    }

    const double unconstrained = posterior->log_density(point).value();
    const double natural = posterior->terms({theta.data(), 2}, hyper).value().sum();

    EXPECT_NEAR(unconstrained, natural + log_jacobian, 1e-6 * std::abs(natural) + 1e-6);
  }
}

TEST(Posterior, AChangeOfThetaAloneUsesTheKeptFactor) {
  auto cached = Posterior::make(toy_model(2, 12), toy_parameters(), toy_data(), kPrior);
  ASSERT_TRUE(cached.has_value());
  Rng rng(6);
  Eigen::VectorXd point = cached->draw_start(rng);
  (void)cached->log_density(point);
  for (int repeat = 0; repeat < 20; ++repeat) {
    if (repeat % 5 == 4) point(4) += 0.3;  // now and then the hyper-parameters too
    point(0) += 0.1;
    Posterior fresh(*cached);
    EXPECT_EQ(cached->log_density(point).value(), fresh.log_density(point).value());
  }
}

TEST(Posterior, ACopyKeepsTheWeights) {
  auto original = Posterior::make(toy_model(2, 12), toy_parameters(), toy_data(0.3), kPrior);
  ASSERT_TRUE(original.has_value());
  Posterior copy(*original);
  Rng rng(7);
  const Eigen::VectorXd point = original->draw_start(rng);
  EXPECT_EQ(original->log_density(point).value(), copy.log_density(point).value());
}

// The weight's purpose: a vanishing one removes its output from the likelihood but for a constant,
// in theta and in the hyper-parameters alike.
TEST(Posterior, AVanishingWeightLeavesTheOtherOutputAlone) {
  const HyperPrior prior = make_hyper_prior(HyperPriorProfile::scaled, 0.05);
  auto both = Posterior::make(toy_model(2, 12), toy_parameters(), toy_data(1e-8), prior);
  PosteriorData first = toy_data();
  first.points.resize(12);
  first.values = first.values.head(12).eval();
  first.extra_variances = first.extra_variances.head(12).eval();
  first.common_errors.resize(12, 0);
  auto alone = Posterior::make(toy_model(2, 12), toy_parameters(), first, prior);
  ASSERT_TRUE(both.has_value() && alone.has_value());
  Rng rng(8);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int repeat = 0; repeat < 200; ++repeat) {
    Eigen::VectorXd theta(2);
    Hyperparameters hyper{0.0, 0.0, Eigen::VectorXd(3)};
    both->to_natural(both->draw_start(rng), theta, hyper);
    const std::vector<double> values(theta.begin(), theta.end());
    const double with = log_likelihood(*both, hyper, values);
    hyper.beta.conservativeResize(2);
    const double difference = with - log_likelihood(*alone, hyper, values);
    low = std::min(low, difference);
    high = std::max(high, difference);
  }
  EXPECT_LT(high - low, 1e-5);
}

TEST(Posterior, JitterOnlyAfterAFailedFactorisation) {
  auto posterior = Posterior::make(toy_model(2, 12), toy_parameters(), toy_data(), kPrior);
  ASSERT_TRUE(posterior.has_value());
  EXPECT_TRUE(posterior->set_hyperparameters({100.0, 1000.0, Eigen::Vector3d(1.0, 1.0, 1.0)}));
  EXPECT_EQ(posterior->jitter_count(), 0);

  // No noise and no distance: a matrix of ones has rank one.
  EXPECT_TRUE(posterior->set_hyperparameters({1.0, 1e30, Eigen::Vector3d::Zero()}));
  EXPECT_EQ(posterior->jitter_count(), 1);

  // And a discrepancy against which 1e-10 is nothing.
  EXPECT_FALSE(posterior->set_hyperparameters({1e-30, 1e30, Eigen::Vector3d::Zero()}));
}

TEST(Posterior, FarAwayPointsHaveDensityZeroNotNaN) {
  auto posterior = Posterior::make(toy_model(2, 12), toy_parameters(), toy_data(), kPrior);
  ASSERT_TRUE(posterior.has_value());
  for (const double far : {-800.0, 800.0, -1e6, 1e6}) {
    for (Eigen::Index j = 0; j < posterior->dimension(); ++j) {
      Eigen::VectorXd point = Eigen::VectorXd::Zero(posterior->dimension());
      point(j) = far;
      const auto value = posterior->log_density(point);
      ASSERT_TRUE(value.has_value());
      EXPECT_FALSE(std::isnan(*value)) << "coordinate " << j << " at " << far;
    }
  }
}

TEST(Posterior, AModelThatFailsNamesTheParameterValues) {
  const FunctionModel model(2, 2, 12, [](std::span<const double> theta, std::span<double> values) {
    std::fill(values.begin(), values.end(), 1000.0);
    if (theta[1] > 12.0) values[14] = std::numeric_limits<double>::quiet_NaN();
  });
  auto posterior = Posterior::make(model, toy_parameters(), toy_data(), kPrior);
  ASSERT_TRUE(posterior.has_value());
  ASSERT_TRUE(posterior->set_hyperparameters({100.0, 1000.0, Eigen::Vector3d(1.0, 1.0, 1.0)}));
  EXPECT_TRUE(posterior->log_likelihood(std::vector<double>{1.0, 11.0}).has_value());

  const auto failed = posterior->log_likelihood(std::vector<double>{1.25, 13.5});

  ASSERT_FALSE(failed.has_value());
  EXPECT_EQ(failed.error().code, ErrorCode::not_finite);
  EXPECT_THAT(failed.error().message, HasSubstr("output 2, month 3"));
  EXPECT_THAT(failed.error().message, HasSubstr("gain = 1.25 kW/K, balance_point = 13.5 degC"));
}

TEST(Posterior, ACovarianceWithoutFactorIsRefusedAtTheStart) {
  const HyperPrior hopeless{"custom", {1.0, 1e30}, {1.0, 1e-30}, {1e12, 1e-12}};
  const auto posterior = Posterior::make(toy_model(2, 12), toy_parameters(), toy_data(), hopeless);
  ASSERT_FALSE(posterior.has_value());
  EXPECT_EQ(posterior.error().code, ErrorCode::not_positive_definite);
}

}  // namespace
}  // namespace recald::calibration::posterior_test
