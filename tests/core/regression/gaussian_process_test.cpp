#include "core/regression/gaussian_process.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "core/random/rng.hpp"

namespace recald::regression::gaussian_process_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd random_points(Index rows, Index columns, std::uint64_t seed) {
  Rng rng(seed);
  MatrixXd points(rows, columns);
  for (double& x : points.reshaped()) x = rng.uniform();
  return points;
}

/// Bent in the first, straight in the second; the third does nothing.
VectorXd values(const MatrixXd& points) {
  return (8.0 * points.col(0).array()).sin() + 2.0 * points.col(1).array() - 1.0;
}

TEST(GaussianProcess, FindsWhichParametersMatterAndHow) {
  const MatrixXd points = random_points(80, 3, 1);
  const GaussianProcess process = fit_gaussian_process(points, values(points), usual_kernel(3));
  const VectorXd& relevance = process.kernel.relevance;
  EXPECT_GT(relevance(0), 100.0 * relevance(1));
  EXPECT_GT(relevance(0), 100.0 * relevance(2));
  const MatrixXd others = random_points(200, 3, 2);
  const VectorXd predicted = kernel_values(process.kernel, others, points) * process.weights;
  const double error = std::sqrt((predicted - values(others)).squaredNorm() / 200.0);
  EXPECT_LT(error, 0.01);
  EXPECT_LT(std::sqrt(process.left_out.squaredNorm() / 80.0), 3.0 * error);
}

TEST(GaussianProcess, LeavesRowsOutAsIfTheyHadNeverBeen) {
  const MatrixXd points = random_points(20, 3, 3);
  const VectorXd y = values(points);
  const GaussianProcess process = fit_gaussian_process(points, y, usual_kernel(3));
  const MatrixXd others = points.bottomRows(19);
  MatrixXd k = kernel_values(process.kernel, others, others);
  k.diagonal().array() += process.kernel.noise;
  const VectorXd weights = k.fullPivLu().solve(y.tail(19));
  const double predicted =
      (kernel_values(process.kernel, points.topRows(1), others) * weights).value();
  EXPECT_NEAR(process.left_out(0), y(0) - predicted, 1e-6);
}

/// Minus the logarithm of likelihood and priors, written out.
double unlikelihood(const MatrixXd& points, const VectorXd& y, const Kernel& kernel) {
  MatrixXd k = kernel_values(kernel, points, points);
  k.diagonal().array() += kernel.noise;
  const auto factor = k.fullPivLu();
  const double count = static_cast<double>(y.size());
  const auto score = [](double value, double mean, double sd) {
    return 0.5 * std::pow((std::log(value) - mean) / sd, 2);
  };
  double value = 0.5 * count * std::log(y.dot(factor.solve(y)) / count) +
                 0.5 * factor.matrixLU().diagonal().array().abs().log().sum() +
                 score(kernel.linear, 0.0, 4.0) + score(kernel.quadratic, 0.0, 4.0) +
                 score(kernel.noise, -9.0, 4.0);
  for (const double relevance : kernel.relevance) value += score(relevance, -2.0, 2.0);
  return value;
}

// A wrong slope of any of them would end the search beside the top.
TEST(GaussianProcess, ItsKernelIsTheMostLikelyOne) {
  const MatrixXd points = random_points(60, 3, 5);
  Rng rng(6);
  VectorXd y = values(points);
  for (double& one : y) one += 0.05 * rng.normal();
  const Kernel best = fit_gaussian_process(points, y, usual_kernel(3)).kernel;
  const double least = unlikelihood(points, y, best);
  for (const double factor : {std::exp(-0.5), std::exp(0.5)}) {
    Kernel other = best;
    other.linear *= factor;
    EXPECT_GT(unlikelihood(points, y, other), least - 1e-3);
    other = best;
    other.quadratic *= factor;
    EXPECT_GT(unlikelihood(points, y, other), least - 1e-3);
    other = best;
    other.noise *= factor;
    EXPECT_GT(unlikelihood(points, y, other), least - 1e-3);
    for (Index j = 0; j < 3; ++j) {
      other = best;
      other.relevance(j) *= factor;
      EXPECT_GT(unlikelihood(points, y, other), least - 1e-3);
    }
  }
}

// By hand: points 0 and 1/2 of one parameter, relevance 4: exp(-1/2), c . c' = 0.
TEST(GaussianProcess, KernelByHand) {
  const Kernel kernel{
      .relevance = VectorXd::Constant(1, 4.0), .linear = 2.0, .quadratic = 3.0, .noise = 9.0};
  const MatrixXd a = MatrixXd::Zero(1, 1);
  const MatrixXd b = MatrixXd::Constant(1, 1, 0.5);
  EXPECT_DOUBLE_EQ(kernel_values(kernel, a, b)(0, 0), std::exp(-0.5) + 2.0 + 3.0);
  EXPECT_DOUBLE_EQ(kernel_values(kernel, a, a)(0, 0), 1.0 + 2.0 * 1.25 + 3.0 * 1.25 * 1.25);
}

// More rows than the kernel is chosen by: all of them are predicted by.
TEST(GaussianProcess, UsesAllRows) {
  const MatrixXd points = random_points(kRowsForKernel + 50, 2, 4);
  const VectorXd y = values(points);
  const GaussianProcess process = fit_gaussian_process(points, y, usual_kernel(2));
  ASSERT_EQ(process.weights.size(), points.rows());
  const VectorXd fitted = kernel_values(process.kernel, points, points) * process.weights;
  EXPECT_LT((fitted - y).tail(50).cwiseAbs().maxCoeff(), 1e-2);
}

}  // namespace
}  // namespace recald::regression::gaussian_process_test
