#include "core/calibration/samplers/seed_rwm.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/calibration/posterior/diagnostics.hpp"
#include "tests/core/calibration/chain_checks.hpp"
#include "tests/core/calibration/sampling_targets.hpp"

namespace recald::calibration::seed_rwm_test {
namespace {

TEST(SeedRwm, FindsTheMomentsOfACorrelatedNormal) {
  SkewNormal target(8);
  const auto chains = run_chains(seed_rwm, target, {}, 11);
  for (const Chain& chain : chains) {
    EXPECT_GT(chain.statistics.acceptance_rate, 0.15);
    EXPECT_LT(chain.statistics.acceptance_rate, 0.40);
  }
  for (Eigen::Index j = 0; j < 8; ++j) {
    SCOPED_TRACE(j);
    const Eigen::MatrixXd draws = coordinate(chains, j);
    const Diagnostics d = diagnose(draws);
    EXPECT_LT(d.rhat, 1.01);
    EXPECT_GT(d.ess_bulk, 1000.0);
    expect_moments(draws, target.mean(j), target.covariance(j, j));
  }
}

// A density with a hard end: exponential on x > 0. Mean 1, and never a draw below the end.
TEST(SeedRwm, RespectsRegionsOfZeroDensity) {
  FunctionTarget target(1, 3.0, [](const Eigen::VectorXd& x) {
    return x(0) > 0.0 ? -x(0) : -std::numeric_limits<double>::infinity();
  });
  Rng rng(12);
  const Chain chain = seed_rwm(target, {60'000, 3'000, {}}, rng).value();
  EXPECT_GT(chain.draws.minCoeff(), 0.0);
  const Diagnostics d = diagnose(chain.draws);
  EXPECT_NEAR(chain.draws.mean(), 1.0, 4.0 * d.mcse);
}

TEST(SeedRwm, OneIterationIsOneProposal) {
  FunctionTarget target(3, 10.0, [](const Eigen::VectorXd& x) { return -0.5 * x.squaredNorm(); });
  Rng rng(13);
  const Chain chain = seed_rwm(target, {500, 100, {}}, rng).value();
  EXPECT_EQ(target.evaluations, 501);  // and the start
  EXPECT_EQ(chain.statistics.density_evaluations, 501);
  EXPECT_EQ(chain.statistics.gradient_evaluations, 0);
  EXPECT_EQ(chain.draws.rows(), 400);
  expect_log_densities_belong_to_draws(chain, target);
}

TEST(SeedRwm, SameSeedSameBytes) { expect_same_seed_same_bytes(seed_rwm, {2000, 500, {}}); }

TEST(SeedRwm, GoesOnAsIfItHadNotEnded) { expect_continuing_is_the_same_chain(seed_rwm, 1000); }
TEST(SeedRwm, GoesOnWhereItEnded) {
  expect_continuing_keeps_the_law(seed_rwm, {6000, 3000, {}}, 10'000);
}

// Two chains whose adaptation ended alike would differ only by their random numbers; that the
// proposal no longer changes after the burn-in shows in the set of step lengths: no new width
// appears.
TEST(SeedRwm, ProposalsAreFrozenAfterBurnIn) {
  FunctionTarget target(1, 1.0, [](const Eigen::VectorXd&) { return 0.0; });  // accepts everything
  Rng rng(15);
  const Chain chain = seed_rwm(target, {40'000, 1'000, {}}, rng).value();
  const Eigen::VectorXd steps =
      (chain.draws.bottomRows(38'999) - chain.draws.topRows(38'999)).cwiseAbs();
  const double longest_early = steps.head(19'000).maxCoeff();
  const double longest_late = steps.tail(19'000).maxCoeff();
  // Acceptance is 1, so a tuner still at work would widen the steps without end.
  EXPECT_NEAR(longest_late / longest_early, 1.0, 1e-3);
}

TEST(SeedRwm, CancellingLeavesNoDamage) {
  expect_cancellation_leaves_no_damage(seed_rwm, {2000, 500, {}}, 1);
}

TEST(SeedRwm, ReportsProgressUpToTheEnd) {
  SkewNormal target(2);
  Rng rng(17);
  int last = 0;
  ASSERT_TRUE(seed_rwm(target, {1234, 100, {}}, rng, [&](int done, int total) {
                EXPECT_GT(done, last);
                EXPECT_EQ(total, 1234);
                last = done;
                return true;
              }).has_value());
  EXPECT_EQ(last, 1234);
}

TEST(SeedRwm, ErrorsOfTheTargetPassThrough) {
  expect_errors_pass_through(seed_rwm, {300, 100, {}}, 37);
}

TEST(SeedRwm, NowhereToStartIsSaid) { expect_nowhere_to_start_is_said(seed_rwm); }
TEST(SeedRwm, BurnInHasToLeaveDraws) { expect_refusals_of_options(seed_rwm); }
TEST(SeedRwm, StatesOfOtherModelsAreRefused) { expect_refusals_of_states(seed_rwm); }

}  // namespace
}  // namespace recald::calibration::seed_rwm_test
