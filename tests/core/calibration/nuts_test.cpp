#include "core/calibration/samplers/nuts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <numbers>

#include "core/calibration/posterior/diagnostics.hpp"
#include "core/calibration/samplers/hamiltonian.hpp"
#include "core/calibration/samplers/step_size.hpp"
#include "core/calibration/samplers/trajectory.hpp"
#include "core/calibration/samplers/warm_up.hpp"
#include "tests/core/calibration/chain_checks.hpp"
#include "tests/core/calibration/sampling_targets.hpp"

namespace recald::calibration {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Result<Chain> run_nuts(Target& target, const SamplerOptions& options, Rng& rng,
                       const SamplerObserver& observer) {
  return nuts(target, options, rng, observer);
}

PhasePoint point_of(Hamiltonian& hamiltonian, const Target& target, Rng& rng) {
  PhasePoint point(target.dimension());
  point.position = target.draw_start(rng);
  for (double& r : point.momentum) r = rng.normal();
  EXPECT_TRUE(hamiltonian.evaluate(point).has_value());
  return point;
}

Eigen::MatrixXd some_factor(Eigen::Index d) {
  return Eigen::MatrixXd(SkewNormal(d).covariance.llt().matrixL());
}

TEST(Hamiltonian, TheLeapfrogGoesBackTheWayItCame) {
  Banana target(5);
  Hamiltonian hamiltonian(target);
  hamiltonian.set_metric_factor(some_factor(5));
  Rng rng(51);
  const PhasePoint start = point_of(hamiltonian, target, rng);
  PhasePoint point = start;
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(hamiltonian.leapfrog(point, 0.05).has_value());
  EXPECT_GT((point.position - start.position).norm(), 0.5);
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(hamiltonian.leapfrog(point, -0.05).has_value());
  EXPECT_LT((point.position - start.position).norm(), 1e-11);
  EXPECT_LT((point.momentum - start.momentum).norm(), 1e-11);
}

// A second-order integrator: over the same time, half the step has a quarter of the energy error.
TEST(Hamiltonian, TheEnergyErrorFallsWithTheSquareOfTheStep) {
  SkewNormal target(5);
  Hamiltonian hamiltonian(target);
  hamiltonian.set_metric_factor(some_factor(5));
  Rng rng(52);
  const PhasePoint start = point_of(hamiltonian, target, rng);
  const auto error_after_one = [&](int steps) {
    PhasePoint point = start;
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(hamiltonian.leapfrog(point, 1.0 / steps));
    return Hamiltonian::energy(point) - Hamiltonian::energy(start);
  };
  EXPECT_NEAR(error_after_one(20) / error_after_one(40), 4.0, 0.1);
  EXPECT_NEAR(error_after_one(40) / error_after_one(80), 4.0, 0.05);
}

// With L' L = covariance a normal density is the unit oscillator in every direction: a quarter of
// its period turns position into momentum.
TEST(Hamiltonian, TheMetricMakesANormalDensityTheUnitOscillator) {
  SkewNormal target(4);
  Hamiltonian hamiltonian(target);
  const Eigen::MatrixXd factor = target.covariance.llt().matrixL();
  hamiltonian.set_metric_factor(factor);
  Rng rng(53);
  const PhasePoint start = point_of(hamiltonian, target, rng);
  PhasePoint point = start;
  constexpr int steps = 2000;
  const double step = 0.5 * std::numbers::pi / steps;
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(hamiltonian.leapfrog(point, step).has_value());
  EXPECT_LT((point.position - target.mean - factor * start.momentum).norm(), 1e-4);
}

TEST(TrajectorySampler, ATransitionKeepsDensityAndForceOfItsPoint) {
  Banana target(5);
  Hamiltonian hamiltonian(target);
  Rng rng(54);
  PhasePoint point = point_of(hamiltonian, target, rng);
  TrajectorySampler trajectories(hamiltonian, rng, 8, 1000.0);
  for (int i = 0; i < 50; ++i) {
    const Transition transition = trajectories.transition(point, 0.2).value();
    EXPECT_GE(transition.acceptance, 0.0);
    EXPECT_LE(transition.acceptance, 1.0);
    PhasePoint fresh = point;
    ASSERT_TRUE(hamiltonian.evaluate(fresh).has_value());
    EXPECT_EQ(fresh.log_density, point.log_density);
    EXPECT_TRUE(fresh.force == point.force);
  }
}

// On a unit normal density a trajectory turns after about half a period, pi in time: with steps of
// 0.1 that are 31, and the doublings end at 32 as a rule. A rule that looks at the wrong end of a
// trajectory walks a tenth further.
TEST(TrajectorySampler, TrajectoriesTurnAfterHalfAPeriod) {
  FunctionTarget target(
      10, 1.0, [](const Eigen::VectorXd& x) { return -0.5 * x.squaredNorm(); }, true);
  Hamiltonian hamiltonian(target);
  Rng rng(55);
  PhasePoint point = point_of(hamiltonian, target, rng);
  TrajectorySampler trajectories(hamiltonian, rng, 10, 1000.0);
  const long before = hamiltonian.gradient_evaluations();
  constexpr int transitions = 2000;
  for (int i = 0; i < transitions; ++i) {
    const Transition transition = trajectories.transition(point, 0.1).value();
    EXPECT_FALSE(transition.at_depth_limit);
    EXPECT_FALSE(transition.diverged);
  }
  const double mean =
      static_cast<double>(hamiltonian.gradient_evaluations() - before) / transitions;
  EXPECT_GT(mean, 31.0);
  EXPECT_LT(mean, 34.0);
}

// Acceptance falls with the step as a function known here, so the step asked for is known too.
TEST(DualAveraging, ReachesItsTarget) {
  for (const double wanted : {0.6, 0.8, 0.95}) {
    DualAveraging averaging(wanted);
    averaging.restart(1.0);
    double step = 1.0;
    for (int i = 0; i < 500; ++i) step = averaging.update(std::exp(-3.0 * step * step));
    EXPECT_NEAR(std::exp(-3.0 * averaging.mean_step() * averaging.mean_step()), wanted, 0.01);
  }
}

TEST(ReasonableStep, CrossesTheThresholdFromEitherSide) {
  SkewNormal target(5);
  Hamiltonian hamiltonian(target);
  Rng rng(56);
  PhasePoint point = point_of(hamiltonian, target, rng);
  const double from_below = reasonable_step(hamiltonian, point, 1e-6, rng).value();
  const double from_above = reasonable_step(hamiltonian, point, 1e3, rng).value();
  for (const double step : {from_below, from_above}) {
    EXPECT_GT(step, 0.02);
    EXPECT_LT(step, 4.0);
  }
}

TEST(ReasonableStep, EndsOnAFlatDensity) {
  FunctionTarget target(
      2, 1.0, [](const Eigen::VectorXd&) { return 0.0; }, true);
  Hamiltonian hamiltonian(target);
  Rng rng(57);
  PhasePoint point = point_of(hamiltonian, target, rng);
  EXPECT_TRUE(std::isfinite(reasonable_step(hamiltonian, point, 1.0, rng).value()));
}

TEST(WindowEnds, DoubleInLength) {
  // Of 1000: 75, then 25, 50, 100, 200, and 500 instead of 400 as 800 more would not fit.
  EXPECT_THAT(window_ends(1000, false), ElementsAre(75, 100, 150, 250, 450, 950));
  EXPECT_THAT(window_ends(300, false), ElementsAre(75, 100, 150, 250));
  EXPECT_THAT(window_ends(150, false), ElementsAre(75, 100));
  EXPECT_THAT(window_ends(100, false), ElementsAre(15, 90));
  EXPECT_THAT(window_ends(100, true), ElementsAre(10, 90));
  EXPECT_THAT(window_ends(19, false), IsEmpty());
}

// Exact for a normal density but for the shrinkage, whatever metric stands before.
TEST(MetricEstimator, FindsTheCovarianceOfANormalFromFewPoints) {
  SkewNormal target(13);
  const Eigen::MatrixXd truth = target.covariance.llt().matrixL();
  const Eigen::MatrixXd before = 2.0 * Eigen::MatrixXd::Identity(13, 13);
  Hamiltonian hamiltonian(target);
  hamiltonian.set_metric_factor(before);
  MetricEstimator estimator(13, 60);
  Rng rng(58);
  PhasePoint point(13);
  for (int i = 0; i < 60; ++i) {
    Eigen::VectorXd unit(13);
    for (double& u : unit) u = rng.normal();
    point.position = target.mean + truth * unit;
    ASSERT_TRUE(hamiltonian.evaluate(point).has_value());
    estimator.add(point.position, point.force);
  }
  const Eigen::MatrixXd factor = estimator.factor(before);
  // Directions of the density measured in the metric: all of length one if they agree.
  const Eigen::MatrixXd relative = factor.triangularView<Eigen::Lower>().solve(truth);
  const Eigen::VectorXd lengths = relative.jacobiSvd().singularValues();
  EXPECT_LT(lengths.maxCoeff(), 1.6);
  EXPECT_GT(lengths.minCoeff(), 1.0 / 1.6);
}

TEST(MetricEstimator, KeepsThePresentMetricWithoutPoints) {
  const Eigen::MatrixXd before = some_factor(3);
  EXPECT_TRUE(MetricEstimator(3, 10).factor(before) == before);
}

TEST(Nuts, FindsTheMomentsOfACorrelatedNormal) {
  SkewNormal target(13);
  const auto chains = run_chains(run_nuts, target, {1'500, 500, {}}, 61);
  long gradients = 0;
  for (const Chain& chain : chains) {
    EXPECT_GT(chain.statistics.acceptance_rate, 0.75);
    EXPECT_EQ(chain.statistics.divergences, 0);
    EXPECT_GT(chain.statistics.e_bfmi, 0.6);
    gradients += chain.statistics.gradient_evaluations;
  }
  double smallest = std::numeric_limits<double>::infinity();
  for (Eigen::Index j = 0; j < 13; ++j) {
    SCOPED_TRACE(j);
    const Eigen::MatrixXd draws = coordinate(chains, j);
    EXPECT_LT(diagnose(draws).rhat, 1.01);
    smallest = std::min(smallest, diagnose(draws).ess_bulk);
    expect_moments(draws, target.mean(j), target.covariance(j, j));
  }
  EXPECT_GT(smallest, 3'000.0);
  EXPECT_LT(static_cast<double>(gradients) / smallest, 30.0);
}

TEST(Nuts, FindsTheMomentsOfABanana) {
  Banana target(13);
  const auto chains = run_chains(run_nuts, target, {2'500, 500, {}}, 62);
  for (Eigen::Index j = 0; j < 4; ++j) {
    SCOPED_TRACE(j);
    EXPECT_LT(diagnose(coordinate(chains, j)).rhat, 1.01);
    expect_moments(coordinate(chains, j), 0.0, target.variance(j));
  }
}

TEST(Nuts, FindsTheQuantilesOfExponentialTails) {
  Logistic target(5);
  const auto chains = run_chains(run_nuts, target, {3'500, 500, {}}, 63);
  for (Eigen::Index j = 0; j < 5; ++j) {
    for (const double p : {0.01, 0.05, 0.5, 0.95, 0.99}) {
      expect_quantile(coordinate(chains, j), p, Logistic::quantile(p));
    }
  }
}

// A hard end: beyond it the density is zero, so trajectories that cross it diverge and are told so,
// and no draw lies there.
TEST(Nuts, ZeroDensityIsADivergenceAndNotAnError) {
  FunctionTarget target(
      2, 1.0,
      [](const Eigen::VectorXd& x) {
        return x(0) > 0.0 ? -0.5 * x.squaredNorm() : -std::numeric_limits<double>::infinity();
      },
      true);
  Rng rng(64);
  const Chain chain = nuts(target, {1500, 500, {}}, rng).value();
  EXPECT_GT(chain.statistics.divergences, 0);
  EXPECT_GT(chain.draws.col(0).minCoeff(), 0.0);
  EXPECT_TRUE(chain.log_density.allFinite());
}

// Neal's funnel has a neck that no single step fits: divergences or a low E-BFMI have to tell.
TEST(Nuts, TellsThatAFunnelIsHard) {
  FunctionTarget target(
      6, 1.0,
      [](const Eigen::VectorXd& x) {
        const double v = x(0);
        return -v * v / 18.0 - 0.5 * x.tail(5).squaredNorm() * std::exp(-v) - 2.5 * v;
      },
      true);
  Rng rng(65);
  const Chain chain = nuts(target, {1500, 500, {}}, rng).value();
  EXPECT_TRUE(chain.statistics.divergences > 0 || chain.statistics.e_bfmi < 0.3)
      << chain.statistics.divergences << ' ' << chain.statistics.e_bfmi;
}

// What NUTS cannot do: cross from one of two separate hills to the other. Chains begun at draws
// from the prior end on either and R-hat has to say so, since nothing else in the chains does.
TEST(Nuts, TwoSeparateModesShowInRhat) {
  TwoModes target(13, 0.7, 12.0);
  const auto chains = run_chains(run_nuts, target, {800, 300, {}}, 66, 8);
  EXPECT_GT(diagnose(coordinate(chains, 0)).rhat, 1.2);
  for (const Chain& chain : chains) EXPECT_EQ(chain.statistics.divergences, 0);
}

TEST(Nuts, CountsWhatItDoes) {
  SkewNormal target(5);
  Rng rng(67);
  const Chain chain = nuts(target, {600, 300, {}}, rng, {}, {.depth_max = 1}).value();
  EXPECT_EQ(chain.draws.rows(), 300);
  EXPECT_GT(chain.statistics.depth_limit_hits, 0);
  EXPECT_LE(chain.statistics.depth_limit_hits, 300);
  // One step an iteration, one evaluation a start and a metric, and the search for steps.
  EXPECT_GE(chain.statistics.gradient_evaluations, 600);
  EXPECT_LE(chain.statistics.gradient_evaluations, 600 + 5 * 42);
  EXPECT_EQ(chain.statistics.density_evaluations, 1);
  expect_log_densities_belong_to_draws(chain, target);
}

// With the covariance of the density to begin with, a burn-in of 60 is as good as one of 500.
TEST(Nuts, AShortBurnInIsEnoughFromAKnownShape) {
  SkewNormal target(13);
  const ChainState state{target.mean, 0.5, target.covariance};
  const auto chains = run_chains(run_nuts, target, {1'060, 60, state}, 68);
  for (Eigen::Index j = 0; j < 13; ++j) {
    SCOPED_TRACE(j);
    EXPECT_GT(diagnose(coordinate(chains, j)).ess_bulk, 2'000.0);
    expect_moments(coordinate(chains, j), target.mean(j), target.covariance(j, j));
  }
}

TEST(Nuts, SameSeedSameBytes) { expect_same_seed_same_bytes(run_nuts, {400, 200, {}}); }
TEST(Nuts, GoesOnAsIfItHadNotEnded) { expect_continuing_is_the_same_chain(run_nuts, 300); }
TEST(Nuts, GoesOnWhereItEnded) { expect_continuing_keeps_the_law(run_nuts, {700, 300, {}}, 2'000); }
TEST(Nuts, CancellingLeavesNoDamage) {
  expect_cancellation_leaves_no_damage(run_nuts, {300, 150, {}}, 7);
}
TEST(Nuts, ErrorsOfTheTargetPassThrough) {
  expect_errors_pass_through(run_nuts, {120, 60, {}}, 61);
}
TEST(Nuts, NowhereToStartIsSaid) { expect_nowhere_to_start_is_said(run_nuts); }
TEST(Nuts, BurnInHasToLeaveDraws) { expect_refusals_of_options(run_nuts); }
TEST(Nuts, StatesOfOtherModelsAreRefused) { expect_refusals_of_states(run_nuts); }

TEST(Nuts, ATargetWithoutGradientIsRefused) {
  FunctionTarget target(2, 1.0, [](const Eigen::VectorXd&) { return 0.0; });
  Rng rng(69);
  const auto chain = nuts(target, {200, 100, {}}, rng);
  ASSERT_FALSE(chain.has_value());
  EXPECT_EQ(chain.error().code, ErrorCode::unsupported);
  EXPECT_THAT(chain.error().message, HasSubstr("choose dram or smc"));
}

TEST(Nuts, OptionsOutOfRangeAreRefused) {
  for (const NutsOptions& options :
       {NutsOptions{.target_acceptance = 1.0}, NutsOptions{.depth_max = 0},
        NutsOptions{.divergence_energy = 0.0}}) {
    SkewNormal target(2);
    Rng rng(70);
    const auto chain = nuts(target, {200, 100, {}}, rng, {}, options);
    ASSERT_FALSE(chain.has_value());
    EXPECT_EQ(chain.error().code, ErrorCode::invalid_value);
  }
}

}  // namespace
}  // namespace recald::calibration
