#include "core/model/metamodel/quadratic_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <vector>

#include "core/random/rng.hpp"
#include "tests/support/allocations.hpp"

namespace recald::model::metamodel {
namespace {

using regression::Term;

constexpr int kParameters = 6;
constexpr int kOutputs = 2;
constexpr int kMonths = 24;
constexpr int kRows = kOutputs * kMonths;

/// Every term in every row, on axes of different lengths.
QuadraticModel random_model(std::uint64_t seed, bool squares) {
  Rng rng(seed);
  std::vector<regression::ColumnScale> scales;
  for (int j = 0; j < kParameters; ++j)
    scales.push_back({1.0 * j, 1.0 * j + rng.uniform(0.1, 9.0)});
  QuadraticCoefficients coefficients(scales, kOutputs, kMonths);
  for (int k = 0; k < kOutputs; ++k) {
    for (int i = 0; i < kMonths; ++i) {
      coefficients.add_constant(k, i, rng.normal());
      for (const Term& term : regression::all_terms(kParameters, squares)) {
        coefficients.add(k, i, term, rng.normal());
      }
    }
  }
  return QuadraticModel(coefficients);
}

std::vector<double> random_point(Rng& rng) {
  std::vector<double> theta;
  for (int j = 0; j < kParameters; ++j) theta.push_back(j + rng.uniform(0.1, 2.0));
  return theta;
}

// f = 3 + 2 s + 5 s t + 7 t^2 with s = (x - 10) / 10, t = y / 4; at x = 15, y = 1: s = 0.5, t =
// 0.25.
TEST(QuadraticModel, EvaluatesByHand) {
  QuadraticCoefficients coefficients({{10.0, 20.0}, {0.0, 4.0}}, 1, 2);
  coefficients.add_constant(0, 1, 3.0);
  coefficients.add(0, 1, {0}, 2.0);
  coefficients.add(0, 1, {1, 0}, 4.0);
  coefficients.add(0, 1, {0, 1}, 1.0);  // the same product
  coefficients.add(0, 1, {1, 1}, 7.0);
  QuadraticModel model(coefficients);
  EXPECT_EQ(model.terms().size(), 3U);
  const std::vector<double> theta{15.0, 1.0};
  std::vector<double> outputs(2);
  std::vector<double> jacobian(4);
  model.evaluate_with_jacobian(theta, outputs, jacobian);
  EXPECT_DOUBLE_EQ(outputs[0], 0.0);
  EXPECT_DOUBLE_EQ(outputs[1], 3.0 + 1.0 + 0.625 + 0.4375);
  EXPECT_THAT(jacobian, ::testing::ElementsAre(0.0, (2.0 + 1.25) / 10.0,  // by x
                                               0.0, (2.5 + 3.5) / 4.0));  // by y
}

TEST(QuadraticModel, JacobianAgreesWithCentralDifferences) {
  for (const bool squares : {false, true}) {
    QuadraticModel model = random_model(1, squares);
    Rng rng(2);
    for (int repeat = 0; repeat < 10; ++repeat) {
      const std::vector<double> theta = random_point(rng);
      std::vector<double> outputs(kRows);
      std::vector<double> jacobian(kRows * kParameters);
      model.evaluate_with_jacobian(theta, outputs, jacobian);
      std::vector<double> plain(kRows);
      model.evaluate(theta, plain);
      EXPECT_EQ(plain, outputs);
      for (std::size_t j = 0; j < kParameters; ++j) {
        const double step = 1e-5;
        std::vector<double> above = theta;
        std::vector<double> below = theta;
        above[j] += step;
        below[j] -= step;
        std::vector<double> high(kRows);
        std::vector<double> low(kRows);
        model.evaluate(above, high);
        model.evaluate(below, low);
        for (std::size_t row = 0; row < kRows; ++row) {
          const double difference = (high[row] - low[row]) / (2.0 * step);
          EXPECT_NEAR(jacobian[j * kRows + row], difference,
                      1e-6 * std::max(1.0, std::abs(difference)));
        }
      }
    }
  }
}

TEST(QuadraticModel, EvaluatesWithoutTheHeap) {
  QuadraticModel model = random_model(3, true);
  Rng rng(4);
  const std::vector<double> theta = random_point(rng);
  std::vector<double> outputs(kRows);
  std::vector<double> jacobian(kRows * kParameters);
  const long before = testing::allocation_count();
  testing::let_eigen_allocate(false);
  for (int i = 0; i < 10; ++i) {
    model.evaluate(theta, outputs);
    model.evaluate_with_jacobian(theta, outputs, jacobian);
  }
  testing::let_eigen_allocate(true);
  EXPECT_EQ(testing::allocation_count(), before);
}

TEST(QuadraticModel, AClonePredictsTheSame) {
  QuadraticModel model = random_model(5, true);
  const auto clone = model.clone();
  Rng rng(6);
  std::vector<double> mine(kRows);
  std::vector<double> its(kRows);
  const std::vector<double> theta = random_point(rng);
  model.evaluate(theta, mine);
  clone->evaluate(theta, its);
  EXPECT_EQ(mine, its);
  EXPECT_TRUE(clone->has_jacobian());
}

}  // namespace
}  // namespace recald::model::metamodel
