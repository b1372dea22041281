#include "core/calibration/samplers/dram.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/calibration/posterior/diagnostics.hpp"
#include "tests/core/calibration/chain_checks.hpp"
#include "tests/core/calibration/sampling_targets.hpp"

namespace recald::calibration {
namespace {

TEST(Dram, FindsTheMomentsOfACorrelatedNormal) {
  SkewNormal target(13);
  const auto chains = run_chains(dram, target, {30'000, 10'000, {}}, 21);
  for (Eigen::Index j = 0; j < 13; ++j) {
    SCOPED_TRACE(j);
    const Eigen::MatrixXd draws = coordinate(chains, j);
    EXPECT_LT(diagnose(draws).rhat, 1.01);
    EXPECT_GT(diagnose(draws).ess_bulk, 800.0);
    expect_moments(draws, target.mean(j), target.covariance(j, j));
  }
}

TEST(Dram, FindsTheMomentsOfABanana) {
  Banana target(4);
  const auto chains = run_chains(dram, target, {40'000, 5'000, {}}, 22);
  for (Eigen::Index j = 0; j < 4; ++j) {
    SCOPED_TRACE(j);
    expect_moments(coordinate(chains, j), 0.0, target.variance(j));
  }
}

TEST(Dram, FindsTheQuantilesOfExponentialTails) {
  Logistic target(5);
  const auto chains = run_chains(dram, target, {30'000, 5'000, {}}, 23);
  for (Eigen::Index j = 0; j < 5; ++j) {
    for (const double p : {0.01, 0.05, 0.5, 0.95, 0.99}) {
      expect_quantile(coordinate(chains, j), p, Logistic::quantile(p));
    }
  }
}

// A hard end is where the second stage is accepted most often, and where a wrong ratio shows:
// exponential on x > 0, mean and variance 1.
TEST(Dram, RespectsRegionsOfZeroDensity) {
  FunctionTarget target(1, 3.0, [](const Eigen::VectorXd& x) {
    return x(0) > 0.0 ? -x(0) : -std::numeric_limits<double>::infinity();
  });
  const auto chains = run_chains(dram, target, {60'000, 3'000, {}}, 24);
  const Eigen::MatrixXd draws = coordinate(chains, 0);
  EXPECT_GT(draws.minCoeff(), 0.0);
  expect_moments(draws, 1.0, 1.0);
  expect_quantile(draws, 0.05, -std::log(0.95));
}

TEST(Dram, ASecondTryCostsAnEvaluationAndMovesMoreOften) {
  FunctionTarget target(3, 10.0, [](const Eigen::VectorXd& x) { return -0.5 * x.squaredNorm(); });
  Rng rng(25);
  const Chain chain = dram(target, {3000, 1000, {}}, rng).value();
  EXPECT_EQ(chain.statistics.density_evaluations, target.evaluations);
  EXPECT_GT(target.evaluations, 3001 + 1500);  // three of four first tries are refused
  EXPECT_LT(target.evaluations, 3001 + 2700);
  EXPECT_GT(chain.statistics.acceptance_rate, 0.35);
  EXPECT_EQ(chain.draws.rows(), 2000);
  expect_log_densities_belong_to_draws(chain, target);
}

TEST(Dram, ANaNIsNeverMovedTo) {
  FunctionTarget target(1, 1.0, [](const Eigen::VectorXd& x) {
    return x(0) > 1.0 ? std::numeric_limits<double>::quiet_NaN() : -0.5 * x(0) * x(0);
  });
  Rng rng(26);
  const Chain chain = dram(target, {4000, 1000, {}}, rng).value();
  EXPECT_LE(chain.draws.maxCoeff(), 1.0);
  EXPECT_LT(chain.draws.minCoeff(), -1.0);  // and the proposal has learnt no NaN
  EXPECT_TRUE(chain.log_density.allFinite());
}

TEST(Dram, SameSeedSameBytes) { expect_same_seed_same_bytes(dram, {2000, 500, {}}); }
TEST(Dram, GoesOnAsIfItHadNotEnded) { expect_continuing_is_the_same_chain(dram, 1000); }
TEST(Dram, GoesOnWhereItEnded) { expect_continuing_keeps_the_law(dram, {6000, 3000, {}}, 10'000); }
TEST(Dram, CancellingLeavesNoDamage) {
  expect_cancellation_leaves_no_damage(dram, {2000, 500, {}}, 1);
}
TEST(Dram, ErrorsOfTheTargetPassThrough) { expect_errors_pass_through(dram, {300, 100, {}}, 37); }
TEST(Dram, NowhereToStartIsSaid) { expect_nowhere_to_start_is_said(dram); }
TEST(Dram, BurnInHasToLeaveDraws) { expect_refusals_of_options(dram); }
TEST(Dram, StatesOfOtherModelsAreRefused) { expect_refusals_of_states(dram); }

}  // namespace
}  // namespace recald::calibration
