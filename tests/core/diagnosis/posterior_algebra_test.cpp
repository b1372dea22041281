#include "core/diagnosis/evidence/posterior_algebra.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "core/diagnosis/evidence/false_discovery.hpp"
#include "core/random/rng.hpp"

namespace recald::diagnosis::posterior_algebra_test {
namespace {

Eigen::MatrixXd normals(Eigen::Index rows, Eigen::Index columns, Rng& rng) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns,
                                      [&rng](Eigen::Index, Eigen::Index) { return rng.normal(); });
}

/// Twenty hours, base model theta_0 + theta_1 x, effect every fifth hour, pattern in even hours.
class Toy : public ::testing::Test {
 protected:
  Toy()
      : design{Eigen::VectorXd::LinSpaced(20, 1.0, 20.0), Eigen::MatrixXd::Zero(20, 1), {}},
        columns(20, 4) {
    for (int t = 1; t <= 20; ++t) {
      const double x = std::cos(2.0 * std::numbers::pi * t / 20.0);
      const double s = t % 5 == 0 ? 1.0 : 0.0;
      design.patterns(t - 1, 0) = t % 2 == 0 ? 1.0 : 0.0;
      columns.row(t - 1) << 0.5 + 0.8 * x + 0.9 * s + 0.25 * std::sin(1.7 * t) +
                                0.15 * std::cos(2.9 * t),
          1.0, x, s;
    }
    before.add(noise(), columns);
    after = marginalise(before, Eigen::MatrixXd::Identity(2, 2)).value();
  }
  [[nodiscard]] BlockNoise noise() const {
    return {design,
            {.structure_sd = 0.3, .correlation_h = 2.0, .white_sd = 0.2, .pattern_sd = 0.2}};
  }
  /// Sums of the smoother with the first q parameters in the model.
  [[nodiscard]] ResidualShares shares(Eigen::Index q) const {
    const auto found = posterior(before, Eigen::MatrixXd::Identity(q, q)).value();
    const Eigen::MatrixXd jacobian = columns.middleCols(1, q);
    return noise().residual_shares(columns.col(0) - jacobian * found.mean, jacobian,
                                   found.covariance);
  }
  BlockDesign design;
  Eigen::MatrixXd columns;  ///< [y | 1 | x | s]
  GramSystem before;        ///< Under Sigma^-1.
  GramSystem after;         ///< Under M: [y | s].
};

// Figures computed independently with dense matrices.
TEST_F(Toy, DetectabilityAndScore) {
  EXPECT_NEAR(detectability(after)[0], 6.263806, 5e-7);
  EXPECT_NEAR(detectability(before)[2], 6.463052, 5e-7);
  EXPECT_NEAR(absorbed_share(before, after)[0], 0.0607, 5e-5);
  EXPECT_NEAR(score(after)[0], 5.747704, 5e-7);
}

TEST_F(Toy, PosteriorOfParametersAndAmount) {
  const auto base = posterior(before, Eigen::MatrixXd::Identity(2, 2)).value();
  EXPECT_NEAR(base.mean[0], 0.744868, 5e-7);
  EXPECT_NEAR(base.mean[1], 0.829574, 5e-7);
  const auto full = posterior(before, Eigen::MatrixXd::Identity(3, 3)).value();
  EXPECT_NEAR(full.mean[0], 0.545184, 5e-7);
  EXPECT_NEAR(full.mean[1], 0.812177, 5e-7);
  EXPECT_NEAR(full.mean[2], 0.894800, 5e-7);
  const double sd = std::sqrt(full.covariance(2, 2));
  EXPECT_NEAR(sd, 0.157651, 5e-7);
  // Savage and Dickey: posterior over prior density where the effect is absent.
  const double density_ratio = std::exp(-0.5 * std::pow(full.mean[2] / sd, 2)) / sd;
  EXPECT_NEAR(density_ratio, 6.41062e-7, 5e-12);
}

TEST_F(Toy, StructuralShareFallsWithTheEffect) {
  const ResidualShares without = shares(2);
  const ResidualShares with = shares(3);
  const double total = without.structural + without.white;
  EXPECT_NEAR(without.structural, 2.097, 5e-4);
  EXPECT_NEAR(with.structural, 1.242, 5e-4);
  EXPECT_NEAR(without.structural / total, 0.608034, 5e-7);
  EXPECT_NEAR(with.structural / total, 0.359937, 5e-7);
  EXPECT_NEAR(with.structural / (with.structural + with.white), 0.631, 5e-4);
}

// Two meters of different length against one dense matrix of both.
TEST(PosteriorAlgebra, MetersAddUpToTheJointModel) {
  Rng rng(4);
  const BlockDesign one{Eigen::VectorXd::LinSpaced(30, 0.0, 116.0), normals(30, 3, rng), {}};
  const BlockDesign two{Eigen::VectorXd::LinSpaced(25, 0.0, 96.0), normals(25, 2, rng), {}};
  const BlockNoise first(one, {1.0, 30.0, 0.5, 0.3});
  const BlockNoise second(two, {0.4, 80.0, 0.9, 0.6});
  const Eigen::MatrixXd columns = normals(55, 6, rng);  // [r | 3 theta | 2 s]
  Eigen::MatrixXd precision = normals(3, 3, rng);
  precision = Eigen::MatrixXd(precision * precision.transpose()) + Eigen::MatrixXd::Identity(3, 3);

  GramSystem system;
  system.add(first, columns.topRows(30));
  system.add(second, columns.bottomRows(25));
  const GramSystem rest = marginalise(system, precision).value();

  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(55, 55);
  covariance.topLeftCorner(30, 30) = first.solve(Eigen::MatrixXd::Identity(30, 30)).inverse();
  covariance.bottomRightCorner(25, 25) = second.solve(Eigen::MatrixXd::Identity(25, 25)).inverse();
  const Eigen::MatrixXd jacobian = columns.middleCols(1, 3);
  covariance += jacobian * precision.inverse() * jacobian.transpose();
  const std::vector<int> kept{0, 4, 5};
  const Eigen::MatrixXd chosen = columns(Eigen::all, kept);
  const Eigen::MatrixXd products = chosen.transpose() * covariance.inverse() * chosen;
  EXPECT_LT((rest.gram - products).cwiseAbs().maxCoeff(), 1e-9 * products.cwiseAbs().maxCoeff());
  EXPECT_NEAR(rest.log_determinant, std::log(covariance.determinant()), 1e-9);
  EXPECT_EQ(rest.points, 55);
  const Eigen::VectorXd d = products.diagonal().tail(2).cwiseSqrt();
  EXPECT_NEAR(confusability(rest)(0, 1), products(1, 2) / (d[0] * d[1]), 1e-9);
  EXPECT_NEAR(score(rest)[1], products(2, 0) / d[1], 1e-9);

  const std::vector<Eigen::Index> swapped{5, 1};
  const GramSystem some = select(system, swapped);
  EXPECT_EQ(some.gram(1, 2), system.gram(5, 1));
  EXPECT_EQ(some.gram(0, 1), system.gram(0, 5));
}

TEST(PosteriorAlgebra, RefusesWhatHasNoFactor) {
  GramSystem system{Eigen::MatrixXd::Identity(3, 3), 0.0, 10};
  EXPECT_EQ(marginalise(system, -Eigen::MatrixXd::Identity(1, 1)).error().code,
            ErrorCode::not_positive_definite);
  system.gram(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(marginalise(system, Eigen::MatrixXd::Identity(2, 2)).error().code,
            ErrorCode::not_positive_definite);
  EXPECT_EQ(posterior(system, Eigen::MatrixXd::Identity(2, 2)).error().code,
            ErrorCode::not_positive_definite);
}

TEST(Nodes, AreCombinedByTheirWeights) {
  const Eigen::Vector3d logs(-1000.0, -1001.0, -5000.0);
  const Eigen::Vector3d weights = Eigen::Vector3d(0.25, 0.5, 0.25).array().log();
  EXPECT_NEAR(combine_nodes(logs, weights), -1000.0 + std::log(0.25 + 0.5 * std::exp(-1.0)), 1e-12);
  const Eigen::VectorXd posterior_weights = node_weights(logs, weights);
  EXPECT_NEAR(posterior_weights.sum(), 1.0, 1e-12);
  EXPECT_NEAR(posterior_weights[1] / posterior_weights[0], 2.0 * std::exp(-1.0), 1e-12);
}

// Four scores of rank two: the first is invisible, the last the sum of the two between.
TEST(NullScores, HaveTheirCorrelationThoughSingular) {
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Zero(4, 4);
  const double half = std::sqrt(0.5);
  correlation.bottomRightCorner(3, 3) << 1.0, 0.0, half, 0.0, 1.0, half, half, half, 1.0;
  Rng rng(6);
  constexpr int draws = 40'000;
  const Eigen::MatrixXd scores = draw_scores(correlation, draws, rng);
  const Eigen::MatrixXd sample = scores * scores.transpose() / draws;
  EXPECT_LT((sample - correlation).cwiseAbs().maxCoeff(), 5.0 * std::sqrt(2.0 / draws));
  EXPECT_LT((scores.row(3) - half * (scores.row(1) + scores.row(2))).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_EQ(scores.row(0).cwiseAbs().maxCoeff(), 0.0);
}

TEST(PosteriorAlgebra, InvisibleColumnsScoreNothing) {
  GramSystem system{Eigen::MatrixXd::Identity(4, 4), 0.0, 10};
  system.gram(1, 1) = 0.0;                       // an empty bin
  system.gram(2, 2) = 1e-20;                     // all of it absorbed, but for rounding
  system.gram(0, 2) = system.gram(2, 0) = 1e-9;  // likewise
  system.gram(0, 3) = system.gram(3, 0) = 0.5;
  EXPECT_EQ(score(system), Eigen::Vector3d(0.0, 0.0, 0.5));
  EXPECT_EQ(confusability(system), Eigen::MatrixXd(Eigen::Vector3d(0.0, 0.0, 1.0).asDiagonal()));
}

// Of k independent scores, P(max |z| <= x) = P(|z| <= x)^k.
TEST(NullScores, MaximaOfIndependentScoresHaveTheirClosedForm) {
  Rng rng(9);
  constexpr int draws = 20'000;
  const Eigen::VectorXd maxima = null_maxima(Eigen::MatrixXd::Identity(10, 10), draws, rng);
  for (const double x : {1.5, 2.0, 2.5, 3.0}) {
    const double beyond = 1.0 - std::pow(std::erf(x / std::sqrt(2.0)), 10);
    EXPECT_NEAR(exceedance(maxima, x), beyond,
                4.0 * std::sqrt(beyond * (1.0 - beyond) / draws) + 1.0 / draws);
  }
  EXPECT_EQ(exceedance(maxima, 0.0), 1.0);
  EXPECT_NEAR(exceedance(maxima, 99.0), 1.0 / (draws + 1.0), 1e-15);
  EXPECT_NEAR(normal_p_value(1.959963984540054), 0.05, 1e-12);
  EXPECT_EQ(normal_p_value(-3.0), normal_p_value(3.0));
}

// The whole chain on data that the model made: base parameters and noise drawn, bins scanned. The
// p-values must be uniform (Kolmogorov-Smirnov at 0.999) and discoveries no more than their rate.
TEST(NullCalibration, ScanPValuesAreUniformAndDiscoveriesRare) {
  constexpr Eigen::Index n = 240;
  BlockDesign design{Eigen::VectorXd(n), Eigen::MatrixXd::Zero(n, 6), {}};
  Eigen::MatrixXd columns(n, 3 + 14);  // [r | 2 theta | 6 blocks of the day, 8 fortnights]
  columns.setZero();
  for (Eigen::Index i = 0; i < n; ++i) {
    design.times_h[i] = 4.0 * static_cast<double>(i + (i > 100 ? 60 : 0));
    design.patterns(i, i % 6) = 1.0;
    columns(i, 1) = 1.0;
    columns(i, 2) = std::cos(static_cast<double>(i) / 20.0);
    columns(i, 3 + i % 6) = 1.0;
    columns(i, 9 + i / 30) = 1.0;
  }
  const BlockNoise noise(design, {1.0, 60.0, 0.5, 0.3});
  const Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(2, 2);
  Rng rng(21);
  constexpr int sets = 1000;
  std::vector<double> bin_p;
  std::vector<double> omnibus_p;
  Eigen::VectorXd maxima;
  int sets_with_findings = 0;
  for (int set = 0; set < sets; ++set) {
    columns.col(0) =
        noise.draw(rng) + columns.middleCols(1, 2) * Eigen::Vector2d(rng.normal(), rng.normal());
    GramSystem system;
    system.add(noise, columns);
    const GramSystem scan = marginalise(system, precision).value();
    if (set == 0) maxima = null_maxima(confusability(scan), 4000, rng);
    const Eigen::VectorXd t = score(scan);
    TestFamily family{exceedance(maxima, t.cwiseAbs().maxCoeff()), {}};
    for (const double value : t) family.bin_p_values.push_back(normal_p_value(value));
    bin_p.push_back(family.bin_p_values[3]);
    omnibus_p.push_back(family.omnibus_p);
    const auto found = findings(std::span<const TestFamily>(&family, 1));
    sets_with_findings += std::count(found[0].begin(), found[0].end(), true) > 0 ? 1 : 0;
  }
  for (std::vector<double>* values : {&bin_p, &omnibus_p}) {
    std::sort(values->begin(), values->end());
    double largest = 0.0;
    for (int i = 0; i < sets; ++i) {
      largest =
          std::max(largest, std::abs((*values)[static_cast<std::size_t>(i)] - (i + 0.5) / sets));
    }
    // The omnibus p is itself Monte Carlo: 4000 draws add a quarter of the variance.
    EXPECT_LT(std::sqrt(sets) * largest, 1.95 * std::sqrt(1.25));
  }
  EXPECT_LT(sets_with_findings, 0.05 * sets + 3.0 * std::sqrt(0.05 * 0.95 * sets));
}

}  // namespace
}  // namespace recald::diagnosis::posterior_algebra_test
