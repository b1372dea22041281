#include "core/model/metamodel/gaussian_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random/rng.hpp"
#include "tests/core/regression/made_design.hpp"
#include "tests/support/allocations.hpp"

namespace recald::model::metamodel::gaussian_model_test {
namespace {

constexpr int kMonths = 6;
const std::vector<int> kSomeMonths{4, 0, 1};

/// The first parameter counts up to the second less `gap`, which is in its own units.
regression::MonthlyForm made_form(double gap) {
  regression::DesignData design = regression::made_design(40, kMonths, 0.0);
  design.caps.push_back({0, 1, gap});
  return regression::fit_monthly_form(design).value();
}

std::vector<double> random_point(Rng& rng) {
  return {rng.uniform(20.0, 28.0), rng.uniform(0.3, 1.2), rng.uniform(0.0, 0.1)};
}

TEST(GaussianModel, JacobianAgreesWithCentralDifferences) {
  for (const double gap : {-100.0, -23.0}) {  // no cap, and one that some points are above
    GaussianModel model{made_form(gap), kSomeMonths};
    Rng rng(1);
    const auto rows = static_cast<std::size_t>(model.output_count() * model.month_count());
    ASSERT_EQ(rows, 9U);
    for (int point = 0; point < 20; ++point) {
      const std::vector<double> theta = random_point(rng);
      std::vector<double> outputs(rows);
      std::vector<double> jacobian(rows * 3);
      model.evaluate_with_jacobian(theta, outputs, jacobian);
      EXPECT_EQ(outputs, recald::evaluate(model, theta));
      for (std::size_t j = 0; j < 3; ++j) {
        const double step = 1e-5 * std::vector{8.0, 0.9, 0.1}[j];
        std::vector<double> above = theta;
        std::vector<double> below = theta;
        above[j] += step;
        below[j] -= step;
        const auto high = recald::evaluate(model, above);
        const auto low = recald::evaluate(model, below);
        for (std::size_t i = 0; i < rows; ++i) {
          const double slope = (high[i] - low[i]) / (2.0 * step);
          EXPECT_NEAR(jacobian[j * rows + i], slope, 1e-4 * (1.0 + std::abs(slope)));
        }
      }
    }
  }
}

TEST(GaussianModel, AParameterCountsUpToItsCap) {
  GaussianModel model{made_form(-23.0), kSomeMonths};
  const auto at = [&](double capped) {
    return recald::evaluate(model, std::vector{capped, 0.6, 0.05});
  };
  EXPECT_EQ(at(27.0), at(23.6));
  EXPECT_NE(at(23.0), at(23.6));
}

TEST(GaussianModel, EvaluatesWithoutTheHeap) {
  GaussianModel model{made_form(-100.0), kSomeMonths};
  const std::vector<double> theta{24.0, 0.8, 0.05};
  std::vector<double> outputs(9);
  std::vector<double> jacobian(27);
  const long before = testing::allocation_count();
  testing::let_eigen_allocate(false);
  model.evaluate(theta, outputs);
  model.evaluate_with_jacobian(theta, outputs, jacobian);
  testing::let_eigen_allocate(true);
  EXPECT_EQ(testing::allocation_count(), before);
}

TEST(GaussianModel, AClonePredictsTheSame) {
  GaussianModel model{made_form(-100.0), kSomeMonths};
  const auto clone = model.clone();
  const std::vector<double> theta{21.0, 1.0, 0.02};
  EXPECT_EQ(recald::evaluate(*clone, theta), recald::evaluate(model, theta));
}

}  // namespace
}  // namespace recald::model::metamodel::gaussian_model_test
