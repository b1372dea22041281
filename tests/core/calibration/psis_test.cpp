#include "core/calibration/checks/psis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/random/rng.hpp"

namespace recald::calibration {
namespace {

using ::testing::HasSubstr;

/// Normal log densities of 6 units under 400 draws of a logistic quantity, laid out by the
/// golden-ratio sequence so that R makes the same numbers:
///
///     g <- function(i) (i * 0.6180339887498949) %% 1
///     z <- qlogis(g(s + 37 * u) * 0.998 + 0.001)
///     ll[s, u] <- -0.5 * (0.3 * u - 0.08 * u * z)^2 - 0.1 * u
Eigen::MatrixXd reference_input() {
  Eigen::MatrixXd log_likelihood(400, 6);
  for (int u = 1; u <= 6; ++u) {
    for (int s = 1; s <= 400; ++s) {
      const double p = std::fmod((s + 37 * u) * 0.6180339887498949, 1.0) * 0.998 + 0.001;
      const double distance = 0.3 * u - 0.08 * u * std::log(p / (1.0 - p));
      log_likelihood(s - 1, u - 1) = -0.5 * distance * distance - 0.1 * u;
    }
  }
  return log_likelihood;
}

struct Reference {
  double elpd, standard_error, effective_parameters;
  Eigen::Matrix<double, 6, 1> unit_elpd, pareto_k;
};

// R 4.2, loo 2.5.1: loo(ll, r_eff = rep(1, 6)). Same algorithm, so the same numbers to rounding.
TEST(PsisLoo, GivesTheNumbersOfR) {
  Reference r{-12.19598048492104, 5.35511058854615, 6.52325830200058, {}, {}};
  r.unit_elpd << -0.155880427213116, -0.439533397364109, -0.901193976886216, -1.682387309797498,
      -3.063688327952225, -5.953297045707877;
  r.pareto_k << 0.143574848484651, 0.281215184039831, 0.422435287708123, 0.662504478597500,
      0.988183228486283, 1.567813022245855;
  const LeaveOneOut loo = psis_loo(reference_input()).value();
  EXPECT_NEAR(loo.elpd, r.elpd, 1e-10);
  EXPECT_NEAR(loo.standard_error, r.standard_error, 1e-10);
  EXPECT_NEAR(loo.effective_parameters, r.effective_parameters, 1e-10);
  EXPECT_TRUE(loo.unit_elpd.isApprox(r.unit_elpd, 1e-11)) << loo.unit_elpd;
  EXPECT_TRUE(loo.pareto_k.isApprox(r.pareto_k, 1e-11)) << loo.pareto_k;
}

// The same with r_eff = rep(0.4, 6): correlated draws smooth a longer tail.
TEST(PsisLoo, GivesTheNumbersOfRForCorrelatedDraws) {
  Eigen::Matrix<double, 6, 1> k;
  k << 0.128203710415825, 0.257291655640118, 0.442806326218976, 0.665685866803296,
      1.005942095674789, 1.555787121501025;
  const LeaveOneOut loo = psis_loo(reference_input(), 0.4).value();
  EXPECT_NEAR(loo.elpd, -12.19481690535801, 1e-10);
  EXPECT_TRUE(loo.pareto_k.isApprox(k, 1e-11)) << loo.pareto_k;
}

// weights(psis(-ll[, 5], r_eff = 1), log = TRUE) of R's loo.
TEST(ParetoSmooth, GivesTheWeightsOfR) {
  const SmoothedWeights weights = pareto_smooth(-reference_input().col(4));
  EXPECT_NEAR(weights.log_weight(0), -8.50599131555036, 1e-11);
  EXPECT_NEAR(weights.log_weight(1), -7.59152974026571, 1e-11);
  EXPECT_NEAR(weights.log_weight(99), -6.08420326039745, 1e-11);
  EXPECT_NEAR(weights.log_weight(47), -1.36920415661495, 1e-11);
  EXPECT_NEAR(weights.log_weight.array().exp().sum(), 1.0, 1e-12);
}

// With y_i ~ N(mu, 1) and a flat prior on mu, y_i given the others is normal around their mean with
// variance 1 + 1 / (n - 1): leaving one out needs no sampling.
TEST(PsisLoo, MeetsTheExactAnswerOfANormalMean) {
  constexpr Eigen::Index n = 24;
  Rng rng(31);
  Eigen::VectorXd y(n);
  for (double& value : y) value = rng.normal();
  Eigen::MatrixXd log_likelihood(8'000, n);
  for (Eigen::Index s = 0; s < log_likelihood.rows(); ++s) {
    const double mu = y.mean() + rng.normal() / std::sqrt(static_cast<double>(n));
    log_likelihood.row(s) =
        -0.5 * (y.array() - mu).square() - 0.5 * std::log(2.0 * std::numbers::pi);
  }
  double exact = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double mean = (y.sum() - y(i)) / static_cast<double>(n - 1);
    const double variance = 1.0 + 1.0 / static_cast<double>(n - 1);
    exact += -0.5 * (y(i) - mean) * (y(i) - mean) / variance -
             0.5 * std::log(2.0 * std::numbers::pi * variance);
  }
  const LeaveOneOut loo = psis_loo(log_likelihood).value();
  EXPECT_NEAR(loo.elpd, exact, 0.02);
  EXPECT_NEAR(loo.effective_parameters, 1.0, 0.3);
  EXPECT_LT(loo.pareto_k.maxCoeff(), 0.5);
}

TEST(ParetoSmooth, EqualRatiosStayEqualAndHaveNoTail) {
  const SmoothedWeights weights = pareto_smooth(Eigen::VectorXd::Constant(100, -3.0));
  EXPECT_NEAR(weights.log_weight.minCoeff(), -std::log(100.0), 1e-12);
  EXPECT_NEAR(weights.log_weight.maxCoeff(), -std::log(100.0), 1e-12);
  EXPECT_EQ(weights.pareto_k, std::numeric_limits<double>::infinity());
}

// R's loo says Inf for 20 draws as well.
TEST(ParetoSmooth, TooFewDrawsForATailAreNotTrusted) {
  const SmoothedWeights weights = pareto_smooth(reference_input().col(0).head(20));
  EXPECT_EQ(weights.pareto_k, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(weights.log_weight.array().exp().sum(), 1.0, 1e-12);
}

TEST(PsisLoo, SaysWhatItLacks) {
  const auto none = psis_loo(Eigen::MatrixXd(100, 0));
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::not_enough_data);
  EXPECT_THAT(none.error().message, HasSubstr("at least one unit and five draws, not 0 and 100"));

  Eigen::MatrixXd broken = reference_input();
  broken(7, 2) = std::numeric_limits<double>::quiet_NaN();
  const auto not_finite = psis_loo(broken);
  ASSERT_FALSE(not_finite.has_value());
  EXPECT_EQ(not_finite.error().code, ErrorCode::not_finite);
  EXPECT_THAT(not_finite.error().message, HasSubstr("unit 3 of 6"));
}

}  // namespace
}  // namespace recald::calibration
