#include "core/calibration/samplers/smc.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/calibration/posterior/diagnostics.hpp"
#include "core/calibration/samplers/particles.hpp"
#include "tests/core/calibration/chain_checks.hpp"
#include "tests/core/calibration/sampling_targets.hpp"

namespace recald::calibration {
namespace {

using ::testing::HasSubstr;

Result<Chain> run_smc(Target& target, const SamplerOptions& options, Rng& rng,
                      const SamplerObserver& observer) {
  return smc(target, options, rng, observer);
}

Particles numbered(const Eigen::VectorXd& log_weight) {
  const Eigen::Index n = log_weight.size();
  const Eigen::VectorXd numbers = Eigen::VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1));
  return {numbers.transpose(), numbers, -numbers, log_weight};
}

TEST(EffectiveCount, CountsEqualWeightsInFullAndOneAsOne) {
  EXPECT_NEAR(effective_count(Eigen::VectorXd::Constant(7, -1234.5)), 7.0, 1e-10);
  constexpr double zero = -std::numeric_limits<double>::infinity();
  EXPECT_NEAR(effective_count(Eigen::Vector4d(zero, 800.0, zero, zero)), 1.0, 1e-12);
  EXPECT_NEAR(effective_count(Eigen::Vector2d(std::log(3.0), 0.0)), 16.0 / 10.0, 1e-12);
  EXPECT_EQ(effective_count(Eigen::Vector2d(zero, zero)), 0.0);
}

// Systematic: a particle of weight w has floor(n w) or ceil(n w) copies, side by side, in order.
TEST(Resample, CopiesInProportionAndInOrder) {
  Rng rng(71);
  for (int repeat = 0; repeat < 200; ++repeat) {
    constexpr Eigen::Index n = 50;
    Eigen::VectorXd log_weight(n);
    for (double& w : log_weight) {
      w = rng.uniform() < 0.3 ? -std::numeric_limits<double>::infinity() : 3.0 * rng.normal();
    }
    Eigen::VectorXd share = log_weight.array().exp();
    share *= static_cast<double>(n) / share.sum();
    Particles particles = numbered(log_weight);
    resample(particles, rng);
    EXPECT_TRUE(particles.log_weight.isZero());
    Eigen::VectorXd copies = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double number = particles.positions(0, i);
      copies(static_cast<Eigen::Index>(number)) += 1.0;
      EXPECT_EQ(particles.log_prior(i), number);
      EXPECT_EQ(particles.log_likelihood(i), -number);
      EXPECT_GE(number, particles.positions(0, std::max<Eigen::Index>(i - 1, 0)));
    }
    for (Eigen::Index k = 0; k < n; ++k) EXPECT_LT(std::abs(copies(k) - share(k)), 1.0 + 1e-9);
  }
}

TEST(Covariance, IsTheWeightedOne) {
  Particles particles = numbered(Eigen::Vector3d(0.0, std::log(2.0), 0.0));
  particles.positions = Eigen::RowVector3d(-1.0, 0.0, 3.0);  // mean 0.5, weights 1/4 1/2 1/4
  EXPECT_NEAR(covariance(particles)(0, 0), (2.25 + 2 * 0.25 + 6.25) / 4.0, 1e-12);
}

TEST(NextTemperature, LeavesHalfOfThePopulation) {
  Particles particles = numbered(Eigen::VectorXd::Zero(400));  // log likelihoods 0 … -399
  const double next = next_temperature(particles, 0.0);
  EXPECT_NEAR(effective_count(next * particles.log_likelihood), 200.0, 1.0);
  particles.log_likelihood *= 1e-6;
  EXPECT_EQ(next_temperature(particles, 0.3), 1.0);
  particles.log_likelihood.head(300).setConstant(-std::numeric_limits<double>::infinity());
  EXPECT_EQ(next_temperature(particles, 0.0), 1.0);  // half of those that live
}

TEST(ParticleMover, LeavesTheDensityAsItIs) {
  ConjugateLinear target(12, 4, 1.0);
  Rng rng(72);
  Particles particles = draw_particles(target, 4'000, rng).value();
  const Eigen::MatrixXd truth = target.posterior_covariance();
  const Eigen::MatrixXd factor = truth.llt().matrixL();
  for (Eigen::Index i = 0; i < particles.count(); ++i) {
    Eigen::VectorXd unit(4);
    for (double& u : unit) u = rng.normal();
    const Eigen::VectorXd position = target.posterior_mean() + factor * unit;
    particles.positions.col(i) = position;
    particles.log_prior(i) = target.log_prior(position);
    particles.log_likelihood(i) = target.log_density(position).value() - particles.log_prior(i);
  }
  ParticleMover mover(target, rng, particles.count(), {});
  ASSERT_TRUE(mover.set_shape(truth).has_value());
  ASSERT_TRUE(mover.move(particles, 1.0).has_value());
  EXPECT_NEAR(mover.acceptance_rate(), 0.27, 0.1);
  EXPECT_EQ(mover.evaluations() % particles.count(), 0);
  EXPECT_GE(mover.evaluations(), 3 * particles.count());
  for (Eigen::Index j = 0; j < 4; ++j) {
    SCOPED_TRACE(j);
    const Eigen::MatrixXd draws = particles.positions.row(j).transpose();
    expect_moments(draws, target.posterior_mean()(j), truth(j, j));
  }
}

TEST(Smc, FindsEvidenceAndMomentsOfAConjugateLinearModel) {
  ConjugateLinear target(24, 6, 0.5);
  const auto chains = run_chains(run_smc, target, {2'048, 0, {}}, 73);
  double mean = 0.0;
  for (const Chain& chain : chains) {
    EXPECT_NEAR(chain.statistics.log_evidence, target.log_evidence(), 0.3);
    EXPECT_GT(chain.statistics.density_evaluations, 3 * 2'048);
    mean += chain.statistics.log_evidence / 4.0;
  }
  EXPECT_NEAR(mean, target.log_evidence(), 0.1);
  for (Eigen::Index j = 0; j < 6; ++j) {
    SCOPED_TRACE(j);
    EXPECT_LT(diagnose(coordinate(chains, j)).rhat, 1.01);
    expect_moments(coordinate(chains, j), target.posterior_mean()(j),
                   target.posterior_covariance()(j, j));
  }
}

// Eight sds apart in thirteen dimensions, 0.7 to 0.3: R-hat passes, each population has the weights
// within four binomial errors of its effective draws, and all four together within four of theirs.
TEST(Smc, KeepsTheWeightsOfSeparateModes) {
  TwoModes target(13, 0.7, 8.0);
  const auto chains = run_chains(run_smc, target, {2'048, 0, {}}, 74);
  const Eigen::MatrixXd first = coordinate(chains, 0);
  EXPECT_LE(diagnose(first).rhat, 1.01);
  const Eigen::MatrixXd left = (first.array() < 0.0).cast<double>();
  const double effective = effective_sample_size(left);
  EXPECT_GT(effective, 1'000.0);
  EXPECT_NEAR(left.mean(), 0.7, 4.0 * std::sqrt(0.21 / effective));
  for (Eigen::Index k = 0; k < 4; ++k) {
    EXPECT_NEAR(left.col(k).mean(), 0.7, 4.0 * std::sqrt(0.21 * 4.0 / effective));
    EXPECT_NEAR(chains[static_cast<std::size_t>(k)].statistics.log_evidence, 0.0, 0.3);
  }
  for (Eigen::Index j = 1; j < 13; ++j) expect_moments(coordinate(chains, j), 0.0, 0.25);
}

TEST(Smc, FindsTheMomentsOfABanana) {
  Banana target(4);
  const auto chains = run_chains(run_smc, target, {2'048, 0, {}}, 75);
  for (Eigen::Index j = 0; j < 4; ++j) {
    SCOPED_TRACE(j);
    expect_moments(coordinate(chains, j), 0.0, target.variance(j));
  }
}

// A quarter of the prior has a positive density: it integrates to 1/4, and no particle is outside.
TEST(Smc, RegionsOfZeroDensityCountInTheEvidence) {
  NormalPriorTarget* self = nullptr;
  FunctionTarget target(2, 1.0, [&](const Eigen::VectorXd& x) {
    const bool inside = x(0) > 0.0 && x(1) > 0.0;
    return inside ? self->log_prior(x) : -std::numeric_limits<double>::infinity();
  });
  self = &target;
  Rng rng(76);
  const Chain chain = smc(target, {2'048, 0, {}}, rng).value();
  EXPECT_GT(chain.draws.minCoeff(), 0.0);
  EXPECT_NEAR(chain.statistics.log_evidence, std::log(0.25), 4.0 * std::sqrt(3.0 / 2'048.0));
}

TEST(Smc, RelativesStandSideBySide) {
  SkewNormal target(5);
  Rng rng(77);
  // Hardly moved, so that copies are still to be seen.
  const Chain chain =
      smc(target, {512, 0, {}}, rng, {}, {.sweeps_min = 1, .sweeps_max = 1}).value();
  const double effective = effective_sample_size(chain.draws.col(0));
  EXPECT_LT(effective, 0.75 * 512.0);
}

TEST(Smc, WhatItHandsOnSuitsAChain) {
  SkewNormal target(5);
  Rng rng(78);
  const Chain chain = smc(target, {1'024, 0, {}}, rng).value();
  EXPECT_TRUE(chain.last.position == chain.draws.bottomRows<1>().transpose());
  for (Eigen::Index j = 0; j < 5; ++j) {
    EXPECT_NEAR(chain.last.covariance(j, j) / target.covariance(j, j), 1.0, 0.4);
  }
  expect_log_densities_belong_to_draws(chain, target);
}

TEST(Smc, SameSeedSameBytes) { expect_same_seed_same_bytes(run_smc, {128, 0, {}}); }
TEST(Smc, CancellingLeavesNoDamage) {
  expect_cancellation_leaves_no_damage(run_smc, {64, 0, {}}, 1);
}
TEST(Smc, ErrorsOfTheTargetPassThrough) { expect_errors_pass_through(run_smc, {32, 0, {}}, 61); }

TEST(Smc, ProgressRisesToTheEnd) {
  SkewNormal target(3);
  Rng rng(79);
  int last = 0;
  ASSERT_TRUE(smc(target, {64, 0, {}}, rng, [&](int done, int total) {
                EXPECT_GE(done, last);
                EXPECT_EQ(total, 64);
                last = done;
                return true;
              }).has_value());
  EXPECT_EQ(last, 64);
}

TEST(Smc, OptionsThatMakeNoSenseAreRefused) {
  const ChainState state{Eigen::VectorXd::Zero(3), 1.0, Eigen::MatrixXd::Identity(3, 3)};
  struct Case {
    SamplerOptions options;
    const char* words;
  };
  for (const Case& c : {Case{{8, 0, {}}, "at least 16 particles, not 8"},
                        Case{{64, 10, {}}, "accepts neither burn-in"},
                        Case{{64, 0, state}, "nor an initial state"}}) {
    SkewNormal target(3);
    Rng rng(80);
    const auto chain = smc(target, c.options, rng);
    ASSERT_FALSE(chain.has_value());
    EXPECT_EQ(chain.error().code, ErrorCode::invalid_value);
    EXPECT_THAT(chain.error().message, HasSubstr(c.words));
  }
}

TEST(Smc, AnImpossiblePosteriorIsSaid) {
  FunctionTarget nowhere(
      1, 1.0, [](const Eigen::VectorXd&) { return -std::numeric_limits<double>::infinity(); });
  Rng rng(81);
  const auto none = smc(nowhere, {64, 0, {}}, rng);
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::not_finite);
  EXPECT_THAT(none.error().message, HasSubstr("none of 64 particles"));
}

// Each temperature gains a factor of about two in six dimensions; a spike of width 1e-150 is
// further than two hundred of them.
TEST(Smc, APosteriorTooNarrowToReachIsSaid) {
  FunctionTarget spike(6, 1.0, [](const Eigen::VectorXd& x) { return -1e300 * x.squaredNorm(); });
  Rng rng(83);
  const auto chain = smc(spike, {256, 0, {}}, rng);
  ASSERT_FALSE(chain.has_value());
  EXPECT_EQ(chain.error().code, ErrorCode::out_of_range) << chain.error().message;
  EXPECT_THAT(chain.error().message, HasSubstr("after 200 temperatures"));
}

// Fewer different points than dimensions span no volume.
TEST(Smc, ACollapsedPopulationIsSaid) {
  FunctionTarget spike(30, 1.0, [](const Eigen::VectorXd& x) { return -1e9 * x.squaredNorm(); });
  Rng rng(82);
  const auto chain = smc(spike, {16, 0, {}}, rng);
  ASSERT_FALSE(chain.has_value());
  EXPECT_EQ(chain.error().code, ErrorCode::not_positive_definite);
  EXPECT_THAT(chain.error().message, HasSubstr("use more particles"));
}

}  // namespace
}  // namespace recald::calibration
