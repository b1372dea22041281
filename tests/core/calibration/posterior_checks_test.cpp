// Leave-out scores and weak directions: what is read off a posterior besides its draws.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/calibration/checks/leave_out.hpp"
#include "core/calibration/checks/weak_directions.hpp"
#include "core/calibration/predictive.hpp"
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

/// One draw of the posterior, `count` times over.
ChainDraws repeated_draw(const Posterior& posterior, Eigen::Index count) {
  ChainDraws chain = single_draws(posterior, 1).front();
  chain.theta = chain.theta.row(0).replicate(count, 1).eval();
  chain.discrepancy_precision = chain.discrepancy_precision.replicate(count, 1).eval();
  chain.error_precision = chain.error_precision.replicate(count, 1).eval();
  chain.beta = chain.beta.row(0).replicate(count, 1).eval();
  chain.log_density.setZero(count);
  return chain;
}

// Densities of figures in units: normalised, and with the range of the output that they are of.
TEST(Predictive, LogLikelihoodsAreRatiosOfLikelihoodsPerUnit) {
  const PosteriorData data = data_of(problem_with_a_gap());
  Posterior whole = Posterior::make(toy_model(2, 12), toy_parameters(), data, kPrior).value();
  const auto chains = single_draws(whole, 3);
  const PointPredictions predictions = predict_points(whole, chains, {}).value();
  ASSERT_EQ(predictions.points.size(), 23u);
  PointBlocks points;
  for (Eigen::Index p = 0; p < 23; ++p) points.push_back({p});
  const Eigen::MatrixXd scores = block_log_scores(whole, chains, 3, points).value();
  for (Eigen::Index p = 0; p < 23; ++p) {
    const int output = predictions.points[static_cast<std::size_t>(p)].output;
    const double range = output == 0 ? 2100.0 : 4100.0;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(predictions.chains[k].log_likelihood(0, p),
                  scores(static_cast<Eigen::Index>(k), p) - std::log(range), 1e-8);
    }
  }
}

// What is drawn has the mean and the spread of the point given the others, in units. Both are found
// from Sigma without its inverse: a regression of the point on the others.
TEST(Predictive, ReplicatesScatterAsThePointGivenTheOthers) {
  const PosteriorData data = data_of(problem_with_a_gap());
  Posterior posterior = Posterior::make(toy_model(2, 12), toy_parameters(), data, kPrior).value();
  constexpr Eigen::Index count = 20'000;
  const ChainDraws chain = repeated_draw(posterior, count);
  const PointPredictions predictions = predict_points(posterior, {chain}, {.seed = 5}).value();
  ASSERT_TRUE(posterior.set_hyperparameters(
      {chain.discrepancy_precision(0), chain.error_precision(0), chain.beta.row(0).transpose()}));
  Eigen::MatrixXd precision(23, 23);
  posterior.precision(precision);
  const Eigen::MatrixXd sigma = precision.inverse();
  const Eigen::VectorXd theta = chain.theta.row(0);
  const Eigen::VectorXd residual = posterior.residual_at({theta.data(), 2});
  for (const Eigen::Index p : {0, 7, 12, 22}) {
    std::vector<Eigen::Index> others;
    for (Eigen::Index i = 0; i < 23; ++i) {
      if (i != p) others.push_back(i);
    }
    const Eigen::VectorXd slopes =
        sigma(others, others).ldlt().solve(Eigen::VectorXd{sigma(others, p)});
    const double sd = std::sqrt(sigma(p, p) - slopes.dot(Eigen::VectorXd{sigma(others, p)}));
    const double normalised =
        data.values(p) - residual(p) + slopes.dot(Eigen::VectorXd{residual(others)});
    const OutputScale scale =
        data.scales[static_cast<std::size_t>(data.points[static_cast<std::size_t>(p)].output)];
    const double mean = scale.min + scale.range() * normalised;
    const Eigen::ArrayXd drawn = predictions.chains[0].replicates.col(p).array();
    const double sd_in_units = sd * scale.range();
    EXPECT_NEAR(drawn.mean(), mean, 4.0 * sd_in_units / std::sqrt(count)) << p;
    EXPECT_NEAR(std::sqrt((drawn - drawn.mean()).square().mean()), sd_in_units,
                4.0 * sd_in_units / std::sqrt(2.0 * count))
        << p;
  }
}

TEST(Predictive, AnyExecutorGivesTheSameNumbersAndMayStop) {
  const Posterior posterior =
      Posterior::make(toy_model(2, 12), toy_parameters(), data_of(problem_with_a_gap()), kPrior)
          .value();
  const std::vector<ChainDraws> chains(3, repeated_draw(posterior, 5));
  const auto forwards = predict_points(posterior, chains, {}).value();
  const ForEachIndex backwards = [](std::size_t n, const std::function<void(std::size_t)>& body) {
    for (std::size_t i = n; i-- > 0;) body(i);
  };
  const auto reversed = predict_points(posterior, chains, {.executor = backwards}).value();
  for (std::size_t k = 0; k < chains.size(); ++k) {
    EXPECT_EQ(forwards.chains[k].replicates, reversed.chains[k].replicates);
  }
  EXPECT_NE(forwards.chains[0].replicates, forwards.chains[1].replicates);
  const auto stopped = predict_points(
      posterior, chains, {.observer = [](const Progress& progress) { return progress.done < 2; }});
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
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
  EXPECT_THAT(findings[0].details, HasSubstr(" up with "));
  EXPECT_THAT(findings[0].details, HasSubstr(" down"));
  EXPECT_TRUE(weak_direction_findings({}, problem.parameters).empty());
}

}  // namespace
}  // namespace recald::calibration::posterior_checks_test
