// Leave-out scores and weak directions: what is read off a posterior besides its draws.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/calibration/leave_out.hpp"
#include "core/calibration/weak_directions.hpp"
#include "tests/core/calibration/toy_models.hpp"

namespace recald::calibration::posterior_checks_test {
namespace {

using ::testing::HasSubstr;

const HyperPrior kPrior{"test", {10.0, 0.02}, {10.0, 0.002}, {1.0, 0.3}};

CalibrationProblem problem_with_a_gap() {
  CalibrationProblem problem = toy_problem(2, 12);
  problem.outputs[1].values[4] = std::numeric_limits<double>::quiet_NaN();
  return problem;
}

PosteriorData data_of(const CalibrationProblem& problem) {
  return normalise_problem(problem, {{{400.0, 2500.0}, {900.0, 5000.0}}, 0.05});
}

/// Chains of one draw each, at values drawn from the prior.
std::vector<ChainDraws> single_draws(const Posterior& posterior, int count) {
  std::vector<ChainDraws> chains;
  Rng rng(3);
  for (int k = 0; k < count; ++k) {
    Chain chain;
    chain.draws = posterior.draw_start(rng).transpose();
    chain.log_density = Eigen::VectorXd::Zero(1);
    chains.push_back(to_natural_units(chain, posterior));
  }
  return chains;
}

TEST(LeaveOut, BlocksHoldAllOutputsOfConsecutiveMonths) {
  const PosteriorData data = data_of(problem_with_a_gap());
  const PointBlocks quarters = blocks_of_months(data.points, 3);
  ASSERT_EQ(quarters.size(), 4u);
  EXPECT_EQ(quarters[0].size(), 6u);
  EXPECT_EQ(quarters[1].size(), 5u);  // month 4 misses one output
  for (const Eigen::Index i : quarters[3]) {
    EXPECT_GE(data.points[static_cast<std::size_t>(i)].month, 9);
  }
  EXPECT_EQ(blocks_of_months(data.points, 5).back().size(), 4u);  // the two months left over
}

// p(y_b | y_rest) = p(y) / p(y_rest), the latter from a posterior that never saw the block.
TEST(LeaveOut, ScoresAreRatiosOfLikelihoods) {
  const PosteriorData data = data_of(problem_with_a_gap());
  Posterior whole = Posterior::make(toy_model(2, 12), toy_parameters(), data, kPrior).value();
  const auto chains = single_draws(whole, 3);
  const PointBlocks blocks = blocks_of_months(data.points, 3);
  const Eigen::MatrixXd scores = block_log_scores(whole, chains, 3, blocks).value();
  for (std::size_t k = 0; k < chains.size(); ++k) {
    const ChainDraws& c = chains[k];
    const Hyperparameters hyper{c.discrepancy_precision(0), c.error_precision(0),
                                c.beta.row(0).transpose()};
    const Eigen::VectorXd theta = c.theta.row(0);
    const std::span<const double> at{theta.data(), 2};
    ASSERT_TRUE(whole.set_hyperparameters(hyper));
    const double of_all = whole.log_likelihood(at).value();
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      CalibrationProblem rest = problem_with_a_gap();
      for (const Eigen::Index i : blocks[b]) {
        const PointIndex& p = data.points[static_cast<std::size_t>(i)];
        rest.outputs[static_cast<std::size_t>(p.output)].values[static_cast<std::size_t>(p.month)] =
            std::numeric_limits<double>::quiet_NaN();
      }
      Posterior others =
          Posterior::make(toy_model(2, 12), toy_parameters(), data_of(rest), kPrior).value();
      ASSERT_TRUE(others.set_hyperparameters(hyper));
      EXPECT_NEAR(scores(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(b)),
                  of_all - others.log_likelihood(at).value(), 1e-8);
    }
  }
}

TEST(LeaveOut, NamesWhatItCannotDo) {
  Posterior posterior =
      Posterior::make(toy_model(2, 12), toy_parameters(), data_of(problem_with_a_gap()), kPrior)
          .value();
  const auto none = block_log_scores(posterior, single_draws(posterior, 3), 3, {});
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::not_enough_data);
  // Three draws are too few for a tail.
  EXPECT_FALSE(leave_out_score(posterior, single_draws(posterior, 3), 1).has_value());
}

/// Outputs see the sum of both parameters and never their difference.
FunctionModel sum_model() {
  return {2, 1, 12, [](std::span<const double> theta, std::span<double> values) {
            for (std::size_t i = 0; i < values.size(); ++i) {
              values[i] = (1.0 + static_cast<double>(i)) * (theta[0] + theta[1]);
            }
          }};
}

TEST(WeakDirections, NamesTheCombinationThatNoMeterSees) {
  CalibrationProblem problem = toy_problem(1, 12);
  problem.parameters = {{"people", "-", {0.0, 0.5, 1.0}}, {"plugs", "-", {0.0, 0.5, 1.0}}};
  Posterior posterior = Posterior::make(sum_model(), problem.parameters,
                                        normalise_problem(problem, {{{0.0, 24.0}}, 0.05}),
                                        {"tight", {10.0, 0.001}, {10.0, 0.0001}, {1.0, 0.3}})
                            .value();
  const auto chains = single_draws(posterior, 5);
  const auto weak = find_weak_directions(posterior, chains, Eigen::Vector2d(0.5, 0.4));
  ASSERT_EQ(weak.size(), 1u);
  EXPECT_NEAR(std::abs(weak[0].loadings(0)), std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(weak[0].loadings(0), -weak[0].loadings(1), 1e-6);
  EXPECT_NEAR(weak[0].information, 0.0, 1e-6);
  const Findings findings = weak_direction_findings(weak, problem.parameters);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].kind, FindingKind::weak_direction);
  EXPECT_THAT(findings[0].sentence, HasSubstr("1 of 2 directions"));
  EXPECT_THAT(findings[0].sentence, HasSubstr(" up with "));
  EXPECT_THAT(findings[0].sentence, HasSubstr(" down"));
  EXPECT_TRUE(weak_direction_findings({}, problem.parameters).empty());
}

}  // namespace
}  // namespace recald::calibration::posterior_checks_test
