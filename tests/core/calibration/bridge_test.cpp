#include "core/calibration/checks/bridge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>
#include <numbers>

#include "core/calibration/samplers/nuts.hpp"
#include "core/calibration/samplers/smc.hpp"
#include "tests/core/calibration/chain_checks.hpp"
#include "tests/core/calibration/sampling_targets.hpp"

namespace recald::calibration {
namespace {

using ::testing::HasSubstr;

/// Independent draws of the posterior of `target`.
Eigen::MatrixXd exact_draws(const ConjugateLinear& target, Eigen::Index count, Rng& rng) {
  Eigen::MatrixXd draws(count, target.dimension());
  const Eigen::MatrixXd factor = target.posterior_covariance().llt().matrixL();
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::VectorXd unit(target.dimension());
    for (double& u : unit) u = rng.normal();
    draws.row(i) = target.posterior_mean() + factor * unit;
  }
  return draws;
}

TEST(Bridge, FindsTheEvidenceOfAConjugateLinearModel) {
  ConjugateLinear target(24, 6, 0.5);
  Rng rng(91);
  const Eigen::MatrixXd draws = exact_draws(target, 2'000, rng);
  const BridgeEstimate estimate = bridge_log_evidence(target, draws, rng).value();
  EXPECT_NEAR(estimate.log_evidence, target.log_evidence(), 4.0 * estimate.mcse);
  EXPECT_LT(estimate.mcse, 0.02);
  EXPECT_LT(estimate.iterations, 100);
}

// The error it states is the error it makes: over 100 repetitions of 200 draws the standardised
// errors have variance 1 within four standard errors sqrt(2 / 99), and no bias to be seen.
TEST(Bridge, ItsStandardErrorIsHonest) {
  ConjugateLinear target(24, 6, 0.5);
  constexpr int repeats = 100;
  double sum = 0.0;
  double squares = 0.0;
  for (std::uint64_t k = 0; k < repeats; ++k) {
    Rng rng(92, k);
    const Eigen::MatrixXd draws = exact_draws(target, 200, rng);
    const BridgeEstimate estimate = bridge_log_evidence(target, draws, rng).value();
    const double standardised = (estimate.log_evidence - target.log_evidence()) / estimate.mcse;
    sum += standardised / repeats;
    squares += standardised * standardised / repeats;
  }
  EXPECT_LT(std::abs(sum), 0.5);
  EXPECT_NEAR(squares, 1.0, 4.0 * std::sqrt(2.0 / 99.0));
}

// The banana in 13 dimensions: its volume is that of a normal density whatever its bend.
TEST(Bridge, AgreesWithSmcAndTheTruthOnABanana) {
  Banana target(13);
  const double exact = 6.5 * std::log(2.0 * std::numbers::pi) + std::log(1.5);
  const auto chains = run_chains([](Target& t, const SamplerOptions& o, Rng& r,
                                    const SamplerObserver& f) { return nuts(t, o, r, f); },
                                 target, {1'500, 500, {}}, 93);
  Eigen::MatrixXd draws(4'000, 13);
  for (Eigen::Index k = 0; k < 4; ++k) {
    draws.middleRows(1'000 * k, 1'000) = chains[static_cast<std::size_t>(k)].draws;
  }
  Rng rng(93, 9);
  const BridgeEstimate estimate = bridge_log_evidence(target, draws, rng).value();
  EXPECT_NEAR(estimate.log_evidence, exact, 0.1);
  EXPECT_NEAR(estimate.log_evidence, exact, 4.0 * estimate.mcse);
  const Chain population = smc(target, {2'048, 0, {}}, rng).value();
  EXPECT_NEAR(population.statistics.log_evidence, estimate.log_evidence, 0.5);
}

TEST(Bridge, SameSeedSameBytes) {
  ConjugateLinear target(24, 6, 0.5);
  const auto run = [&](std::uint64_t seed) {
    Rng draws_rng(94);
    Rng rng(seed);
    const Eigen::MatrixXd draws = exact_draws(target, 200, draws_rng);
    return bridge_log_evidence(target, draws, rng).value().log_evidence;
  };
  EXPECT_EQ(run(1), run(1));
  EXPECT_NE(run(1), run(2));
}

TEST(Bridge, SaysWhatItLacks) {
  ConjugateLinear target(24, 6, 0.5);
  Rng rng(95);
  const auto few = bridge_log_evidence(target, Eigen::MatrixXd::Zero(31, 6), rng);
  ASSERT_FALSE(few.has_value());
  EXPECT_EQ(few.error().code, ErrorCode::not_enough_data);
  EXPECT_THAT(few.error().message,
              HasSubstr("at least 32 draws with as many columns, not 31 of 6"));

  const auto stuck = bridge_log_evidence(target, Eigen::MatrixXd::Zero(100, 6), rng);
  ASSERT_FALSE(stuck.has_value());
  EXPECT_EQ(stuck.error().code, ErrorCode::not_positive_definite);

  Eigen::MatrixXd draws = exact_draws(target, 100, rng);
  draws.bottomRows(50).array() += 1e6;  // the other half has no density under the target
  const auto apart = bridge_log_evidence(target, draws, rng);
  ASSERT_FALSE(apart.has_value());
  EXPECT_EQ(apart.error().code, ErrorCode::not_finite);
  EXPECT_THAT(apart.error().message, HasSubstr("hardly overlap"));
}

TEST(Bridge, ErrorsOfTheTargetPassThrough) {
  for (const int fail_at : {1, 2, 77, 150, 399}) {
    int evaluations = 0;
    FunctionTarget target(6, 1.0, [&](const Eigen::VectorXd& x) -> Result<double> {
      if (++evaluations == fail_at) return failure(ErrorCode::not_finite, "the model broke");
      return -0.5 * x.squaredNorm();
    });
    Rng rng(96);
    Eigen::MatrixXd draws(200, 6);
    for (double& x : draws.reshaped()) x = rng.normal();
    const auto estimate = bridge_log_evidence(target, draws, rng);
    ASSERT_FALSE(estimate.has_value());
    EXPECT_EQ(estimate.error().message, "the model broke");
    EXPECT_EQ(evaluations, fail_at);
  }
}

}  // namespace
}  // namespace recald::calibration
