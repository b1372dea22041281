/// What tests of all samplers ask of them.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/calibration/posterior/diagnostics.hpp"
#include "core/calibration/samplers/sampler.hpp"
#include "core/statistics/quantile.hpp"
#include "tests/core/calibration/sampling_targets.hpp"

namespace recald::calibration {

/// `count` chains of the same target from streams 0, 1, … of `seed`.
inline std::vector<Chain> run_chains(const SampleFunction& sampler, Target& target,
                                     const SamplerOptions& options, std::uint64_t seed,
                                     int count = 4) {
  std::vector<Chain> chains;
  for (int k = 0; k < count; ++k) {
    Rng rng(seed, static_cast<std::uint64_t>(k));
    chains.push_back(sampler(target, options, rng, {}).value());
  }
  return chains;
}

/// One coordinate of all chains, (iterations x chains).
inline Eigen::MatrixXd coordinate(const std::vector<Chain>& chains, Eigen::Index j) {
  Eigen::MatrixXd draws(chains.front().draws.rows(), static_cast<Eigen::Index>(chains.size()));
  for (std::size_t k = 0; k < chains.size(); ++k) {
    draws.col(static_cast<Eigen::Index>(k)) = chains[k].draws.col(j);
  }
  return draws;
}

/// Mean and variance within four standard errors; that of the variance from the draws themselves,
/// as densities differ in their fourth moments.
inline void expect_moments(const Eigen::MatrixXd& draws, double mean, double variance) {
  EXPECT_NEAR(draws.mean(), mean, 4.0 * diagnose(draws).mcse);
  const Eigen::MatrixXd squares = (draws.array() - mean).square();
  EXPECT_NEAR(squares.mean(), variance, 4.0 * diagnose(squares).mcse);
}

/// The share of draws below the p-quantile is p within four standard errors.
inline void expect_quantile(const Eigen::MatrixXd& draws, double p, double quantile) {
  const Eigen::MatrixXd below = (draws.array() <= quantile).cast<double>();
  const double error = std::sqrt(p * (1.0 - p) / effective_sample_size(below));
  EXPECT_NEAR(below.mean(), p, 4.0 * error) << "at quantile " << quantile;
}

/// Fails the n-th evaluation for n = 1, 2, … until a run passes: each failure comes out as it went
/// in, and what the run gives at last is what a target without failures gives.
/// @param stride  From one n to the next, so that a long run is not repeated for each.
inline void expect_errors_pass_through(const SampleFunction& sampler, const SamplerOptions& options,
                                       int stride) {
  const auto density = [](const Eigen::VectorXd& x) { return -0.5 * x.squaredNorm(); };
  const auto run = [&](int fail_at, int& evaluations) {
    FunctionTarget target(
        2, 2.0,
        [&, fail_at](const Eigen::VectorXd& x) -> Result<double> {
          if (++evaluations == fail_at) return failure(ErrorCode::not_finite, "the model broke");
          return density(x);
        },
        true);
    Rng rng(41);
    return sampler(target, options, rng, {});
  };
  int all = 0;
  const Chain whole = run(-1, all).value();
  int failed = 0;
  for (int n = 1;; n += n < 20 ? 1 : stride) {
    int evaluations = 0;
    const auto chain = run(n, evaluations);
    if (chain.has_value()) {
      EXPECT_GT(n, all);
      EXPECT_TRUE(chain->draws == whole.draws);
      break;
    }
    ++failed;
    ASSERT_EQ(evaluations, n) << "the density was asked again after a failure";
    ASSERT_EQ(chain.error().message, "the model broke");
  }
  EXPECT_GT(failed, 19);
}

/// Says no at the n-th call of the observer for n rising until a run passes. The target that was
/// left in the middle then gives what a fresh one gives.
inline void expect_cancellation_leaves_no_damage(const SampleFunction& sampler,
                                                 const SamplerOptions& options, int stride) {
  SkewNormal fresh(3);
  Rng fresh_rng(42);
  const Chain expected = sampler(fresh, options, fresh_rng, {}).value();
  SkewNormal target(3);
  for (int n = 1;; n += stride) {
    int calls = 0;
    Rng rng(42);
    const auto chain = sampler(target, options, rng, [&](int, int) { return ++calls < n; });
    if (chain.has_value()) {
      EXPECT_LT(calls, n);
      EXPECT_GT(n, 1);
      EXPECT_TRUE(chain->draws == expected.draws);
      break;
    }
    ASSERT_EQ(chain.error().code, ErrorCode::cancelled);
    ASSERT_EQ(calls, n);
  }
}

inline void expect_same_seed_same_bytes(const SampleFunction& sampler,
                                        const SamplerOptions& options) {
  const auto run = [&](std::uint64_t seed) {
    SkewNormal target(3);
    Rng rng(seed, 2);
    return sampler(target, options, rng, {}).value();
  };
  const Chain first = run(1);
  const Chain again = run(1);
  EXPECT_TRUE(first.draws == again.draws);
  EXPECT_TRUE(first.log_density == again.log_density);
  EXPECT_TRUE(first.last.position == again.last.position);
  EXPECT_FALSE(first.draws == run(2).draws);
}

inline void expect_log_densities_belong_to_draws(const Chain& chain, Target& target) {
  ASSERT_EQ(chain.log_density.size(), chain.draws.rows());
  for (Eigen::Index i = 0; i < chain.draws.rows(); i += 17) {
    EXPECT_NEAR(chain.log_density(i), target.log_density(chain.draws.row(i).transpose()).value(),
                1e-9);
  }
}

/// A chain cut in two, the second half begun at the state of the first with no burn-in, has the
/// moments of the density; and it adapts no more: scale and covariance are handed on as they were.
inline void expect_continuing_keeps_the_law(const SampleFunction& sampler, SamplerOptions options,
                                            int more) {
  std::vector<Chain> chains;
  SkewNormal target(3);
  for (std::uint64_t k = 0; k < 4; ++k) {
    Rng rng(43, k);
    const Chain first = sampler(target, options, rng, {}).value();
    SamplerOptions rest{.iterations = more, .burn_in = 0, .begin_at = first.last};
    chains.push_back(sampler(target, rest, rng, {}).value());
    EXPECT_EQ(chains.back().draws.rows(), more);
    EXPECT_NEAR(chains.back().last.scale, first.last.scale, 1e-12);
    EXPECT_TRUE(chains.back().last.covariance.isApprox(first.last.covariance, 1e-9));
    EXPECT_NEAR(chains.back().statistics.acceptance_rate, first.statistics.acceptance_rate, 0.1);
  }
  for (Eigen::Index j = 0; j < 3; ++j) {
    SCOPED_TRACE(j);
    expect_moments(coordinate(chains, j), target.mean(j), target.covariance(j, j));
  }
}

/// A chain cut in two goes on as the uncut one, to rounding: with the same generator the same
/// draws, and rates of kept iterations that add up.
inline void expect_continuing_is_the_same_chain(const SampleFunction& sampler, int burn_in) {
  const auto run = [&](const SamplerOptions& options, Rng& rng) {
    SkewNormal target(3);
    return sampler(target, options, rng, {}).value();
  };
  Rng rng(47);
  const Chain whole = run({burn_in + 20, burn_in, {}}, rng);
  Rng cut_rng(47);
  const Chain first = run({burn_in + 10, burn_in, {}}, cut_rng);
  const Chain second = run({10, 0, first.last}, cut_rng);
  EXPECT_TRUE(whole.draws.topRows(10) == first.draws);
  EXPECT_LT((whole.draws.bottomRows(10) - second.draws).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(2.0 * whole.statistics.acceptance_rate,
              first.statistics.acceptance_rate + second.statistics.acceptance_rate, 1e-6);
}

inline void expect_refusals_of_states(const SampleFunction& sampler) {
  struct Case {
    ChainState state;
    ErrorCode code;
    std::string words;
  };
  const Eigen::VectorXd origin = Eigen::VectorXd::Zero(3);
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(3, 3);
  const std::vector<Case> cases{
      {{Eigen::VectorXd::Zero(2), 1.0, unit}, ErrorCode::invalid_value, "has 2 coordinates"},
      {{origin, 1.0, Eigen::MatrixXd::Identity(2, 2)}, ErrorCode::invalid_value, "is 2 x 2"},
      {{origin, 1.0, -unit}, ErrorCode::not_positive_definite, "not positive definite"},
      {{origin, 0.0, unit}, ErrorCode::invalid_value, "initial scale is 0.0"},
      {{Eigen::VectorXd::Constant(3, std::numeric_limits<double>::infinity()), 1.0, unit},
       ErrorCode::not_finite,
       "no positive posterior density"}};
  for (const Case& c : cases) {
    SkewNormal target(3);
    Rng rng(44);
    const SamplerOptions options{.iterations = 100, .burn_in = 0, .begin_at = c.state};
    const auto chain = sampler(target, options, rng, {});
    ASSERT_FALSE(chain.has_value()) << c.words;
    EXPECT_EQ(chain.error().code, c.code);
    EXPECT_NE(chain.error().message.find(c.words), std::string::npos) << chain.error().message;
  }
}

/// Burn-in of nothing without a state, of everything, or of more than there is.
inline void expect_refusals_of_options(const SampleFunction& sampler) {
  const ChainState state{Eigen::VectorXd::Zero(3), 1.0, Eigen::MatrixXd::Identity(3, 3)};
  for (const SamplerOptions& options :
       {SamplerOptions{100, 100, {}}, SamplerOptions{100, 0, {}}, SamplerOptions{0, 0, {}},
        SamplerOptions{10, 20, {}}, SamplerOptions{0, 0, state}, SamplerOptions{5, 5, state}}) {
    SkewNormal target(3);
    Rng rng(45);
    const auto chain = sampler(target, options, rng, {});
    ASSERT_FALSE(chain.has_value());
    EXPECT_EQ(chain.error().code, ErrorCode::invalid_value);
    EXPECT_NE(chain.error().message.find("burn-in"), std::string::npos);
  }
}

inline void expect_nowhere_to_start_is_said(const SampleFunction& sampler) {
  FunctionTarget target(
      1, 1.0, [](const Eigen::VectorXd&) { return -std::numeric_limits<double>::infinity(); },
      true);
  Rng rng(46);
  const auto chain = sampler(target, {200, 100, {}}, rng, {});
  ASSERT_FALSE(chain.has_value());
  EXPECT_EQ(chain.error().code, ErrorCode::not_finite);
  EXPECT_NE(chain.error().message.find("none of 100 starting points"), std::string::npos);
}

}  // namespace recald::calibration
