#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/calibration/gaussian_mixture.hpp"
#include "core/calibration/mode_jumps.hpp"
#include "core/calibration/posterior/diagnostics.hpp"

namespace recald::calibration {
namespace {

constexpr Eigen::Index kDimension = 4;

/// Two unit normals at +-4 in the first coordinate, of unequal weight; integrates to exp(2).
class TwoHills final : public Target {
 public:
  static constexpr double kWeight = 0.7;  ///< Of the hill at +4.

  [[nodiscard]] Eigen::Index dimension() const override { return kDimension; }
  [[nodiscard]] Result<double> log_density(const Eigen::VectorXd& z) override {
    const double constant = 2.0 - 0.5 * kDimension * std::log(2.0 * std::numbers::pi);
    const double rest = -0.5 * z.tail(kDimension - 1).squaredNorm();
    const double right = kWeight * std::exp(-0.5 * (z(0) - 4.0) * (z(0) - 4.0));
    const double left = (1.0 - kWeight) * std::exp(-0.5 * (z(0) + 4.0) * (z(0) + 4.0));
    return constant + rest + std::log(left + right);
  }
  [[nodiscard]] double log_prior(const Eigen::VectorXd&) const override { return 0.0; }
  [[nodiscard]] Eigen::VectorXd draw_start(Rng& rng) const override {
    Eigen::VectorXd z(kDimension);
    for (double& x : z) x = rng.normal();
    return z;
  }
};

/// `right` of `n` points stand on the right hill, the rest on the left.
Eigen::MatrixXd points_on_hills(int n, int right, Rng& rng) {
  Eigen::MatrixXd points(n, kDimension);
  for (double& x : points.reshaped()) x = rng.normal();
  for (int i = 0; i < n; ++i) points(i, 0) += i < right ? 4.0 : -4.0;
  return points;
}

TEST(GaussianMixture, FindsTwoHillsAndTheirWeights) {
  Rng rng(1);
  const GaussianMixture mixture = fit_mixture(points_on_hills(2000, 600, rng), 6, rng);
  ASSERT_EQ(mixture.components().size(), 2u);
  const bool first_is_right = mixture.components()[0].mean(0) > 0.0;
  const GaussianComponent& right = mixture.components()[first_is_right ? 0 : 1];
  EXPECT_NEAR(right.weight, 0.3, 0.005);
  EXPECT_NEAR(right.mean(0), 4.0, 0.15);
  const Eigen::MatrixXd covariance = right.factor * right.factor.transpose();
  EXPECT_LT((covariance - Eigen::MatrixXd::Identity(kDimension, kDimension)).norm(), 0.35);
}

TEST(GaussianMixture, OneHillStaysOne) {
  Rng rng(2);
  EXPECT_EQ(fit_mixture(points_on_hills(1000, 1000, rng), 6, rng).components().size(), 1u);
}

// One component: the normal density written out.
TEST(GaussianMixture, DensityCarriesItsConstant) {
  Rng rng(3);
  const Eigen::MatrixXd points = points_on_hills(500, 500, rng);
  GaussianMixture mixture = fit_mixture(points, 1, rng);
  const GaussianComponent& c = mixture.components()[0];
  const Eigen::MatrixXd covariance = c.factor * c.factor.transpose();
  Eigen::VectorXd z(kDimension);
  for (double& x : z) x = rng.normal();
  const double expected = -0.5 * (z - c.mean).dot(covariance.inverse() * (z - c.mean)) -
                          0.5 * std::log((2.0 * std::numbers::pi * covariance).determinant());
  EXPECT_NEAR(mixture.log_density(z), expected, 1e-9);
}

TEST(GaussianMixture, DrawsFollowTheDensity) {
  Rng rng(4);
  GaussianMixture mixture = widen(fit_mixture(points_on_hills(2000, 600, rng), 6, rng));
  EXPECT_EQ(mixture.components().size(), 3u);
  // The mean of 1 / q over draws of q inside a box is the box's volume: densities and draws agree
  // only if both are right.
  double inverse = 0.0;
  constexpr int n = 400'000;
  Eigen::VectorXd z(kDimension);
  for (int i = 0; i < n; ++i) {
    mixture.draw(rng, z);
    const bool inside = std::abs(z(0) - 4.0) < 1.0 && z.tail(3).cwiseAbs().maxCoeff() < 1.0;
    if (inside) inverse += std::exp(-mixture.log_density(z)) / n;
  }
  EXPECT_NEAR(inverse, 16.0, 0.5);
}

TEST(ModeJumps, GiveTheHillsTheirWeights) {
  Rng rng(5);
  TwoHills target;
  constexpr int n = 1000;
  Chain population{points_on_hills(n, n / 10, rng), Eigen::VectorXd(n), {}, {}};
  for (Eigen::Index i = 0; i < n; ++i) {
    population.log_density(i) = target.log_density(population.draws.row(i).transpose()).value();
  }
  const auto acceptance = jump_between_modes(target, population, rng);
  ASSERT_TRUE(acceptance.has_value());
  EXPECT_GT(*acceptance, 0.2);
  const double right = (population.draws.col(0).array() > 0.0).cast<double>().mean();
  EXPECT_NEAR(right, TwoHills::kWeight, 4.0 * std::sqrt(0.7 * 0.3 / n));
  EXPECT_NEAR(population.statistics.log_evidence, 2.0, 0.02);
  for (Eigen::Index i = 0; i < n; i += 97) {
    const Eigen::VectorXd z = population.draws.row(i);
    EXPECT_EQ(population.log_density(i), target.log_density(z).value());
  }
}

TEST(ModeJumps, StopWhenTold) {
  Rng rng(6);
  TwoHills target;
  Chain population{points_on_hills(200, 100, rng), Eigen::VectorXd::Zero(200), {}, {}};
  int calls = 0;
  const auto stopped =
      jump_between_modes(target, population, rng, 60, [&](int, int) { return ++calls < 3; });
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace recald::calibration
