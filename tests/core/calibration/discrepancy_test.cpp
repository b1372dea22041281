#include "core/calibration/covariance/discrepancy.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random/rng.hpp"

namespace recald::calibration::discrepancy_test {
namespace {

std::vector<PointIndex> all_points(int outputs, int months) {
  std::vector<PointIndex> points;
  for (int k = 0; k < outputs; ++k) {
    for (int i = 0; i < months; ++i) points.push_back({k, i});
  }
  return points;
}

Eigen::MatrixXd covariance_of(DiscrepancyKernel& kernel, double variance,
                              const Eigen::VectorXd& beta) {
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(kernel.point_count(), kernel.point_count());
  kernel.covariance(variance, beta, lower);
  return lower.selfadjointView<Eigen::Lower>();
}

// By hand: scaled inputs (0, 0), (0.5, 0), (0.5, 1), the second the output; beta (1, 0.5), 1/400.
TEST(DiscrepancyKernel, ThreePointsByHand) {
  DiscrepancyKernel kernel(Eigen::Vector2d(0.0, 0.5), {{0, 0}, {0, 1}, {1, 1}});
  const Eigen::MatrixXd c = covariance_of(kernel, 1.0 / 400.0, Eigen::Vector2d(1.0, 0.5));
  EXPECT_NEAR(c(0, 0), 0.0025, 1e-15);
  EXPECT_NEAR(c(0, 1), 0.00194700, 5e-9);
  EXPECT_NEAR(c(0, 2), 0.00118092, 5e-9);
  EXPECT_NEAR(c(1, 2), 0.00151633, 5e-9);
}

TEST(DiscrepancyKernel, OneOutputHasNoOutputDimension) {
  EXPECT_EQ(DiscrepancyKernel(Eigen::MatrixXd::Random(5, 3), all_points(1, 5)).dimension(), 3);
  EXPECT_EQ(DiscrepancyKernel(Eigen::MatrixXd::Random(5, 3), all_points(2, 5)).dimension(), 4);
  // Two outputs of which one was never measured are one.
  EXPECT_EQ(DiscrepancyKernel(Eigen::MatrixXd::Random(5, 3), {{1, 0}, {1, 4}}).dimension(), 3);
}

TEST(DiscrepancyKernel, OutputsAreEquallyFarFromEachOther) {
  DiscrepancyKernel kernel(Eigen::MatrixXd::Zero(1, 1), all_points(4, 1));
  const Eigen::MatrixXd c = covariance_of(kernel, 1.0, Eigen::Vector2d(0.7, 1.1));
  for (Eigen::Index i = 0; i < 4; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) EXPECT_DOUBLE_EQ(c(i, j), std::exp(-1.1));
  }
}

TEST(DiscrepancyKernel, IsPositiveSemiDefiniteForAnyNumberOfOutputs) {
  Rng rng(2);
  for (int repeat = 0; repeat < 30; ++repeat) {
    const int outputs = 1 + repeat % 5;
    Eigen::MatrixXd inputs(8, 2);
    for (double& x : inputs.reshaped()) x = rng.uniform();
    DiscrepancyKernel kernel(inputs, all_points(outputs, 8));
    Eigen::VectorXd beta(kernel.dimension());
    for (double& b : beta) b = rng.uniform(0.0, 8.0);
    const Eigen::MatrixXd c = covariance_of(kernel, 1.0, beta);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(c);
    EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-12 * static_cast<double>(c.rows()));
  }
}

TEST(DiscrepancyKernel, MissingMonthsLeaveTheRestAsItWas) {
  Rng rng(3);
  Eigen::MatrixXd inputs(6, 2);
  for (double& x : inputs.reshaped()) x = rng.uniform();
  const Eigen::VectorXd beta = Eigen::Vector3d(1.0, 2.0, 0.5);
  DiscrepancyKernel whole(inputs, all_points(2, 6));
  DiscrepancyKernel part(inputs, {{0, 1}, {0, 4}, {1, 0}, {1, 4}, {1, 5}});
  const std::vector<Eigen::Index> rows{1, 4, 6, 10, 11};
  const Eigen::MatrixXd expected = covariance_of(whole, 0.3, beta)(rows, rows);
  EXPECT_TRUE(covariance_of(part, 0.3, beta).isApprox(expected, 1e-15));
}

TEST(DiscrepancyKernel, LimitsOfBeta) {
  Eigen::MatrixXd inputs(4, 1);
  inputs << 0.0, 0.5, 0.5, 1.0;  // two months alike
  DiscrepancyKernel kernel(inputs, all_points(1, 4));
  const double inf = std::numeric_limits<double>::infinity();

  const Eigen::MatrixXd constant = covariance_of(kernel, 2.0, Eigen::VectorXd::Zero(1));
  EXPECT_TRUE((constant.array() == 2.0).all());

  const Eigen::MatrixXd white = covariance_of(kernel, 2.0, Eigen::VectorXd::Constant(1, inf));
  EXPECT_LT(white(0, 1), 1e-300);
  EXPECT_EQ(white(1, 2), 2.0) << "equal inputs stay fully correlated";
}

}  // namespace
}  // namespace recald::calibration::discrepancy_test
