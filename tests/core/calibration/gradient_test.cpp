// The analytic gradient against central differences, for every way the covariance is computed.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/calibration/covariance/cholesky.hpp"
#include "core/calibration/posterior/posterior.hpp"

namespace recald::calibration::gradient_test {
namespace {

const HyperPrior kPrior{"test", {10.0, 0.02}, {10.0, 0.002}, {1.0, 0.3}};
// With a != 1 the score of rho is no longer standard normal under the prior.
const HyperPrior kOtherPrior{"test", {4.0, 0.02}, {6.0, 0.002}, {2.5, 0.8}};

/// Curved in three parameters, a different curve for each output and month.
class CurvedModel final : public MonthlyModel {
 public:
  CurvedModel(int outputs, int months) : outputs_(outputs), months_(months) {}

  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override {
    return std::make_unique<CurvedModel>(*this);
  }
  [[nodiscard]] int parameter_count() const override { return 3; }
  [[nodiscard]] int output_count() const override { return outputs_; }
  [[nodiscard]] int month_count() const override { return months_; }
  [[nodiscard]] bool has_jacobian() const override { return true; }
  void evaluate(std::span<const double> theta, std::span<double> values) override {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double x = phase(i);
      values[i] = 2.0 + x * theta[0] + std::sin(x + 0.1 * theta[1]) + 0.02 * theta[1] * theta[2];
    }
  }
  void evaluate_with_jacobian(std::span<const double> theta, std::span<double> values,
                              std::span<double> jacobian) override {
    evaluate(theta, values);
    const std::size_t n = values.size();
    for (std::size_t i = 0; i < n; ++i) {
      const double x = phase(i);
      jacobian[i] = x;
      jacobian[n + i] = 0.1 * std::cos(x + 0.1 * theta[1]) + 0.02 * theta[2];
      jacobian[2 * n + i] = 0.02 * theta[1];
    }
  }

 private:
  static double phase(std::size_t i) { return 0.1 * static_cast<double>(i % 17); }

  int outputs_;
  int months_;
};

std::vector<Parameter> parameters() {
  return {{"slope", "-", {0.0, 0.4, 1.0}},
          {"phase", "-", TruncatedNormalPrior{3.0, 2.0, 0.0}},
          {"gain", "-", LogNormalPrior{1.5, 0.4}}};
}

/// Known errors beside the discrepancy: of each point, or of each month and common to all points.
enum class Extras { none, by_point, by_month };

struct Case {
  const char* name;
  int outputs;
  int months;
  bool missing;
  Extras extras;
  HyperPrior prior;
  friend void PrintTo(const Case& which, std::ostream* out) { *out << which.name; }
};

PosteriorData data_of(const Case& c, Rng& rng) {
  PosteriorData data;
  data.month_inputs.resize(c.months, 3);
  for (double& x : data.month_inputs.reshaped()) x = rng.uniform();
  for (int k = 0; k < c.outputs; ++k) {
    for (int i = 0; i < c.months; ++i) {
      if (!c.missing || rng.uniform() < 0.7) data.points.push_back({k, i});
    }
    data.scales.push_back({1.0 + k, 4.0 + 2.0 * k});
    data.weights.push_back(c.extras == Extras::by_point && k > 0 ? 0.4 : 1.0);
  }
  const auto m = static_cast<Eigen::Index>(data.points.size());
  data.values.resize(m);
  for (double& y : data.values) y = rng.uniform(0.2, 0.8);
  data.extra_variances.setConstant(m, 1e-3);
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

class Gradient : public ::testing::TestWithParam<Case> {};

TEST_P(Gradient, MatchesCentralDifferencesTo1e6) {
  const Case& c = GetParam();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    Rng rng(seed);
    auto posterior =
        Posterior::make(CurvedModel(c.outputs, c.months), parameters(), data_of(c, rng), c.prior);
    ASSERT_TRUE(posterior.has_value());
    ASSERT_TRUE(posterior->has_gradient());
    const Eigen::VectorXd point = 0.7 * posterior->draw_start(rng);
    Eigen::VectorXd gradient(point.size());
    const double value = posterior->log_density_and_gradient(point, gradient).value();
    EXPECT_NEAR(value, posterior->log_density(point).value(), 1e-9 * std::abs(value));
    for (Eigen::Index j = 0; j < point.size(); ++j) {
      // Fourth order, so that neither truncation nor rounding reaches 1e-6.
      constexpr double h = 2e-3;
      constexpr double kink = -0.2533471;  // score of the triangular prior's mode
      if (j == 0 && std::abs(point(j) - kink) < 2.0 * h) continue;
      const auto at = [&](double steps) {
        Eigen::VectorXd moved = point;
        moved(j) += steps * h;
        return posterior->log_density(moved).value();
      };
      const double difference = (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12.0 * h);
      EXPECT_NEAR(gradient(j), difference, 1e-6 * std::max(1.0, std::abs(difference)))
          << "coordinate " << j;
    }
  }
}

TEST_P(Gradient, PrecisionIsTheInverseOfWhatTheLikelihoodUses) {
  const Case& c = GetParam();
  Rng rng(3);
  auto posterior =
      Posterior::make(CurvedModel(c.outputs, c.months), parameters(), data_of(c, rng), c.prior);
  ASSERT_TRUE(posterior.has_value());
  const Eigen::Index m = posterior->point_count();
  Eigen::MatrixXd precision(m, m);
  posterior->precision(precision);
  const double zero = posterior->log_likelihood_of_residual(Eigen::VectorXd::Zero(m));
  Eigen::VectorXd residual(m);
  for (double& r : residual) r = 0.05 * rng.normal();
  EXPECT_NEAR(zero - posterior->log_likelihood_of_residual(residual),
              0.5 * residual.dot(precision * residual), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, Gradient,
    ::testing::Values(Case{"one_output", 1, 12, false, Extras::none, kPrior},
                      Case{"two_outputs", 2, 24, false, Extras::none, kPrior},
                      Case{"three_outputs", 3, 12, false, Extras::none, kOtherPrior},
                      Case{"missing_months", 2, 24, true, Extras::none, kPrior},
                      Case{"common_errors", 3, 12, false, Extras::by_month, kOtherPrior},
                      Case{"weights_and_common_errors", 3, 12, true, Extras::by_point,
                           kOtherPrior}),
    [](const auto& given) { return given.param.name; });

TEST(Cholesky, InverseOfAFactor) {
  Rng rng(1);
  for (const Eigen::Index n : {1, 2, 7, 24, 49}) {
    Eigen::MatrixXd root(n, n);
    for (double& x : root.reshaped()) x = rng.normal();
    const Eigen::MatrixXd matrix = root * root.transpose() + Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd factor = matrix;
    ASSERT_TRUE(factorise_in_place(factor));
    Eigen::MatrixXd scratch(n, n);
    Eigen::MatrixXd inverse(n, n);
    invert_factor(factor, scratch, inverse);
    const Eigen::MatrixXd whole = inverse.selfadjointView<Eigen::Lower>();
    EXPECT_LT((whole * matrix - Eigen::MatrixXd::Identity(n, n)).norm(), 1e-10) << n;
    const Eigen::MatrixXd lower = factor.triangularView<Eigen::Lower>();
    EXPECT_NEAR(log_determinant_of_factor(factor), 2.0 * lower.diagonal().array().log().sum(),
                1e-10);
  }
  Eigen::MatrixXd indefinite = -Eigen::MatrixXd::Identity(3, 3);
  EXPECT_FALSE(factorise_in_place(indefinite));
}

}  // namespace
}  // namespace recald::calibration::gradient_test
