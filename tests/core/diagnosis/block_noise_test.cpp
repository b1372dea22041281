#include "core/diagnosis/evidence/block_noise.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random/rng.hpp"

namespace recald::diagnosis::block_noise_test {
namespace {

constexpr double log_two_pi = 1.8378770664093454836;

/// Sigma as its definition says, element by element.
Eigen::MatrixXd dense_covariance(const BlockDesign& design, const NoiseLevel& level) {
  const Eigen::Index n = design.times_h.size();
  Eigen::MatrixXd covariance =
      std::pow(level.pattern_sd, 2) * design.patterns * design.patterns.transpose();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      covariance(i, j) +=
          std::pow(level.structure_sd, 2) *
          std::exp(-std::abs(design.times_h[i] - design.times_h[j]) / level.correlation_h);
    }
    const bool gated = !design.gated.empty() && design.gated[static_cast<std::size_t>(i)];
    covariance(i, i) += std::pow(level.white_sd, 2) * (gated ? 25.0 : 1.0);
  }
  return covariance;
}

Eigen::MatrixXd normals(Eigen::Index rows, Eigen::Index columns, Rng& rng) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns,
                                      [&rng](Eigen::Index, Eigen::Index) { return rng.normal(); });
}

/// Four-hour blocks with every fifth or so missing, a three-week hole and some gates; patterns are
/// the block of the day (one-hot) and two smooth columns.
BlockDesign random_design(Eigen::Index points, Rng& rng) {
  BlockDesign design{Eigen::VectorXd(points), Eigen::MatrixXd::Zero(points, 8), {}};
  double time_h = 0.0;
  for (Eigen::Index i = 0; i < points; ++i) {
    time_h += 4.0 + (rng.uniform() < 0.2 ? 4.0 * static_cast<double>(rng.below(9)) : 0.0);
    if (i == points / 2) time_h += 504.0;
    design.times_h[i] = time_h;
    design.patterns(i, static_cast<Eigen::Index>(time_h / 4.0) % 6) = 1.0;
    design.patterns(i, 6) = std::cos(time_h / 100.0);
    design.patterns(i, 7) = std::sin(time_h / 100.0);
    design.gated.push_back(rng.uniform() < 0.05);
  }
  return design;
}

NoiseLevel random_level(Rng& rng) {
  return {.structure_sd = rng.uniform(0.1, 3.0),
          .correlation_h = rng.uniform(5.0, 500.0),
          .white_sd = rng.uniform(0.1, 3.0),
          .pattern_sd = rng.uniform(0.05, 2.0)};
}

// Every linear operation against the matrix it stands for.
TEST(BlockNoise, AgreesWithTheDenseCovarianceUnderGapsAndGates) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Rng rng(seed);
    const BlockDesign design = random_design(120, rng);
    const NoiseLevel level = random_level(rng);
    const BlockNoise noise(design, level);
    const Eigen::MatrixXd covariance = dense_covariance(design, level);
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
    const Eigen::MatrixXd columns = normals(120, 5, rng);
    const Eigen::MatrixXd solved = factor.solve(columns);
    const Eigen::MatrixXd products = columns.transpose() * solved;
    const double log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();

    EXPECT_LT((noise.gram(columns) - products).cwiseAbs().maxCoeff(),
              1e-9 * products.cwiseAbs().maxCoeff());
    EXPECT_LT((noise.solve(columns) - solved).cwiseAbs().maxCoeff(),
              1e-9 * solved.cwiseAbs().maxCoeff());
    EXPECT_NEAR(noise.log_determinant(), log_determinant, 1e-9);
    EXPECT_NEAR(noise.marginal_log_density(columns.col(0)),
                -0.5 * (120 * log_two_pi + log_determinant + products(0, 0)), 1e-9);
    const Eigen::VectorXd pattern =
        std::pow(level.pattern_sd, 2) * design.patterns.transpose() * solved.col(0);
    EXPECT_LT((noise.pattern_mean(columns.col(0)) - pattern).cwiseAbs().maxCoeff(), 1e-9);
  }
}

// t_nu(r; 0, Sigma) = integral of N(r; 0, w Sigma) over w ~ inverse gamma(nu / 2, nu / 2).
TEST(BlockNoise, StudentDensityIsTheNormalOneAveragedOverTheSizeOfTheNoise) {
  Rng rng(11);
  const BlockDesign design = random_design(40, rng);
  const BlockNoise noise(design, random_level(rng));
  constexpr double kFreedom = 4.0;
  constexpr double kStep = 0.001;  // of log w
  for (const double size : {0.3, 1.0, 4.0}) {
    SCOPED_TRACE(size);
    const Eigen::VectorXd residual = size * noise.draw(rng);
    const double squares = noise.gram(residual)(0, 0);
    const double normal = noise.marginal_log_density(residual);
    double sum = 0.0;
    for (double log_w = -8.0; log_w < 12.0; log_w += kStep) {
      const double w = std::exp(log_w);
      const double half = 0.5 * kFreedom;
      const double log_prior = half * std::log(half) - std::lgamma(half) - half * log_w - half / w;
      sum += kStep * std::exp(log_prior + 0.5 * squares * (1.0 - 1.0 / w) - 20.0 * log_w);
    }
    EXPECT_NEAR(noise.student_log_density(residual, kFreedom), normal + std::log(sum), 1e-6);
  }
}

// W is what turns u + e into white noise of unit variance, and it is causal.
TEST(BlockNoise, WhiteningMakesTheCovarianceTheIdentity) {
  Rng rng(5);
  const BlockDesign design = random_design(90, rng);
  NoiseLevel level = random_level(rng);
  level.pattern_sd = 0.0;
  const BlockNoise noise(design, level);
  const Eigen::MatrixXd whitening = noise.whiten(Eigen::MatrixXd::Identity(90, 90));

  const Eigen::MatrixXd whitened =
      whitening * dense_covariance(design, level) * whitening.transpose();
  EXPECT_LT((whitened - Eigen::MatrixXd::Identity(90, 90)).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_EQ(whitening.triangularView<Eigen::StrictlyUpper>().toDenseMatrix().cwiseAbs().maxCoeff(),
            0.0);
}

TEST(BlockNoise, NeedsNoPatternAndNoStructure) {
  const BlockDesign design{Eigen::VectorXd::LinSpaced(6, 0.0, 20.0), Eigen::MatrixXd(6, 0), {}};
  const BlockNoise noise(
      design, {.structure_sd = 0.0, .correlation_h = 24.0, .white_sd = 2.0, .pattern_sd = 1.0});
  EXPECT_NEAR(noise.gram(Eigen::VectorXd::Ones(6))(0, 0), 6.0 / 4.0, 1e-14);
  EXPECT_NEAR(noise.log_determinant(), 6.0 * std::log(4.0), 1e-14);
  EXPECT_EQ(noise.pattern_mean(Eigen::VectorXd::Ones(6)).size(), 0);
  const ResidualShares shares =
      noise.residual_shares(Eigen::VectorXd::Ones(6), Eigen::MatrixXd(6, 0), Eigen::MatrixXd(0, 0));
  EXPECT_NEAR(shares.structural, 0.0, 1e-14);
  EXPECT_NEAR(shares.white, 6.0, 1e-14);
}

// Expected squares by conditioning the joint normal of (parameters, structure, noise) on their sum.
TEST(BlockNoise, ResidualSharesAreThoseOfTheJointPosterior) {
  Rng rng(8);
  const BlockDesign design = random_design(80, rng);
  const NoiseLevel level = random_level(rng);
  const Eigen::MatrixXd jacobian = normals(80, 3, rng);
  const Eigen::VectorXd reading = normals(80, 1, rng);
  NoiseLevel white_only = level;
  white_only.structure_sd = white_only.pattern_sd = 0.0;
  const Eigen::MatrixXd all = dense_covariance(design, level);
  const Eigen::MatrixXd white = dense_covariance(design, white_only);
  const Eigen::MatrixXd structure = all - white;
  const Eigen::MatrixXd marginal = (all + jacobian * jacobian.transpose()).inverse();
  const auto expected_squares = [&](const Eigen::MatrixXd& part) {
    return (part * marginal * reading).squaredNorm() + (part - part * marginal * part).trace();
  };

  const BlockNoise noise(design, level);
  const Eigen::MatrixXd products = noise.gram(jacobian);
  const Eigen::MatrixXd covariance = (products + Eigen::MatrixXd::Identity(3, 3)).inverse();
  const Eigen::VectorXd mean = covariance * jacobian.transpose() * noise.solve(reading);
  const ResidualShares shares =
      noise.residual_shares(reading - jacobian * mean, jacobian, covariance);

  EXPECT_NEAR(shares.structural, expected_squares(structure), 1e-9 * shares.structural);
  EXPECT_NEAR(shares.white, expected_squares(white), 1e-9 * shares.white);
}

// The sample covariance of m draws has a standard error below sqrt(2 / m) times its largest entry;
// over 36 entries five of them are never reached by chance.
TEST(BlockNoise, DrawsHaveTheCovariance) {
  Rng rng(3);
  const BlockDesign design = random_design(8, rng);
  const NoiseLevel level{
      .structure_sd = 1.0, .correlation_h = 20.0, .white_sd = 0.7, .pattern_sd = 0.5};
  const BlockNoise noise(design, level);
  constexpr int draws = 40'000;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(8, 8);
  for (int i = 0; i < draws; ++i) {
    const Eigen::VectorXd value = noise.draw(rng);
    sum += value * value.transpose();
  }
  const Eigen::MatrixXd covariance = dense_covariance(design, level);
  EXPECT_LT((sum / draws - covariance).cwiseAbs().maxCoeff(),
            5.0 * std::sqrt(2.0 / draws) * covariance.maxCoeff());
}

/// A year of blocks with the six blocks of the day as patterns.
BlockDesign year_design() {
  constexpr Eigen::Index n = 2190;
  BlockDesign design{Eigen::VectorXd(n), Eigen::MatrixXd::Zero(n, 6), {}};
  for (Eigen::Index i = 0; i < n; ++i) {
    design.times_h[i] = 4.0 * static_cast<double>(i);
    design.patterns(i, i % 6) = 1.0;
  }
  return design;
}

// The truth lies near the top of the density: within it, and by less than a chi-squared of three
// degrees of freedom allows (half of its 99.9 % quantile is 8.1).
TEST(FitLevels, FindsTheLevelsThatMadeTheResidual) {
  const BlockDesign design = year_design();
  for (const NoiseLevel& truth : {NoiseLevel{5.0, 100.0, 3.0, 2.0}, NoiseLevel{2.0, 20.0, 6.0, 2.0},
                                  NoiseLevel{8.0, 300.0, 0.5, 2.0}}) {
    Rng rng(11);
    const BlockNoise noise(design, truth);
    const Eigen::VectorXd residual = noise.draw(rng);
    const auto fit = fit_levels(residual, design, /*mean=*/100.0);
    ASSERT_TRUE(fit.has_value()) << fit.error().message;
    const double at_truth =
        noise.marginal_log_density(residual) - 0.5 * std::pow(truth.structure_sd / 10.0, 2);
    EXPECT_GE(fit->log_density, at_truth - 1e-3);
    EXPECT_LT(fit->log_density, at_truth + 8.1);
    EXPECT_NEAR(std::log(fit->level.white_sd / truth.white_sd), 0.0, 0.3);
    EXPECT_NEAR(std::log(fit->level.structure_sd / truth.structure_sd), 0.0, 0.5);
    EXPECT_DOUBLE_EQ(fit->level.pattern_sd, 2.0);
  }
}

TEST(FitLevels, RefusesTooFewPointsAndNotANumber) {
  const BlockDesign few{Eigen::VectorXd::LinSpaced(9, 0.0, 32.0), Eigen::MatrixXd(9, 0), {}};
  EXPECT_EQ(fit_levels(Eigen::VectorXd::Ones(9), few, 1.0).error().code,
            ErrorCode::not_enough_data);
  const BlockDesign enough{Eigen::VectorXd::LinSpaced(20, 0.0, 76.0), Eigen::MatrixXd(20, 0), {}};
  Eigen::VectorXd broken = Eigen::VectorXd::Ones(20);
  broken[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fit_levels(broken, enough, 1.0).error().code, ErrorCode::not_finite);
}

// A residual of nothing, or a straight step, has its best level at an end of the prior.
TEST(FitLevels, StaysInsideThePriorOnDegenerateResiduals) {
  const BlockDesign design = year_design();
  for (const double step : {0.0, 40.0}) {
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(2190);
    residual.tail(1000).setConstant(step);
    const auto fit = fit_levels(residual, design, 100.0);
    ASSERT_TRUE(fit.has_value());
    // The density is that of the level returned: no gain was found outside the support.
    EXPECT_NEAR(fit->log_density,
                BlockNoise(design, fit->level).marginal_log_density(residual) -
                    0.5 * std::pow(fit->level.structure_sd / 10.0, 2),
                0.01);
    EXPECT_GE(fit->level.white_sd, 0.0099);
    EXPECT_LE(fit->level.correlation_h, 480.1);
    EXPECT_GE(fit->level.correlation_h, 11.9);
  }
}

class ChooseGates : public ::testing::Test {
 protected:
  ChooseGates() : design(year_design()), level{2.0, 100.0, 3.0, 2.0} {
    Rng rng(17);
    residual = BlockNoise(design, level).draw(rng);
    other = BlockNoise(design, level).draw(rng);
  }
  [[nodiscard]] std::vector<std::vector<bool>> gates() const {
    const std::vector<GateInput> meters{{design, residual, level}, {design, other, level}};
    return choose_gates(meters);
  }
  BlockDesign design;
  NoiseLevel level;
  Eigen::VectorXd residual;
  Eigen::VectorXd other;
};

// 200 kW is 60 prediction sd: without care its successor would stand out as well.
TEST_F(ChooseGates, GatesLonelyPoints) {
  residual[500] += 200.0;
  residual[900] -= 30.0;
  const auto gated = gates();
  EXPECT_TRUE(gated[0][500]);
  EXPECT_TRUE(gated[0][900]);
  EXPECT_LE(std::count(gated[0].begin(), gated[0].end(), true), 3);
  EXPECT_LE(std::count(gated[1].begin(), gated[1].end(), true), 1);
}

TEST_F(ChooseGates, LeavesRunsEchoesAndLevelsAlone) {
  residual.segment(500, 2).array() += 40.0;  // a run
  residual[900] += 40.0;                     // an echo: both meters
  other[900] -= 40.0;
  residual.tail(600).array() += 60.0;  // a new level
  const auto gated = gates();
  for (const std::size_t i : {500u, 501u, 900u, 1590u, 1591u, 1592u})
    EXPECT_FALSE(gated[0][i]) << i;
  EXPECT_FALSE(gated[1][900]);
}

TEST_F(ChooseGates, GatesAtMostTwoInAHundred) {
  for (Eigen::Index i = 10; i < 2190; i += 20) residual[i] += i % 40 == 10 ? 60.0 : 200.0;
  const auto gated = gates();
  EXPECT_EQ(std::count(gated[0].begin(), gated[0].end(), true), 43);
}

}  // namespace
}  // namespace recald::diagnosis::block_noise_test
