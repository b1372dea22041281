#include "core/calibration/calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "tests/core/calibration/toy_models.hpp"
#include "tests/support/in_threads.hpp"

namespace recald::calibration::calibration_test {
namespace {

using ::testing::HasSubstr;

CalibrationOptions short_options(int iterations = 4000, int burn_in = 1000) {
  CalibrationOptions options;
  options.design_runs = 60;
  options.sampling.sampler = find_sampler("seed_rwm").value();
  options.sampling.iterations = iterations;
  options.sampling.burn_in = burn_in;
  options.sampling.doublings_max = 0;
  return options;
}

bool has(const Findings& findings, FindingKind kind, const std::string& subject) {
  return std::any_of(findings.begin(), findings.end(),
                     [&](const Finding& f) { return f.kind == kind && f.subject == subject; });
}

// The whole way on a problem whose truth is known up to a wiggle of 2 %.
TEST(Calibrate, FindsTheParametersOfTheToyBuilding) {
  CalibrationOptions options = short_options(20'000, 3'000);
  options.sampling.gate = {.rhat_max = 1.03, .ess_min = 100.0, .mcse_share_max = 0.1};
  const auto c = calibrate(toy_model(2, 24), toy_problem(2, 24), options, {.seed = 3});
  ASSERT_TRUE(c.has_value()) << c.error().message;

  ASSERT_EQ(c->parameters.size(), 2u);
  EXPECT_EQ(c->parameters[0].name, "gain");
  EXPECT_EQ(c->parameters[0].unit, "kW/K");
  EXPECT_NEAR(c->parameters[0].mean, 1.3, 3.0 * c->parameters[0].sd);
  EXPECT_NEAR(c->parameters[1].mean, 11.0, 3.0 * c->parameters[1].sd);
  EXPECT_GT(c->parameters[0].contraction, 0.5);
  EXPECT_EQ(c->posterior_mean(1), c->parameters[1].mean);
  EXPECT_NEAR(c->parameters[0].prior_mean, 3.5 / 3.0, 1e-12);

  EXPECT_EQ(c->design.theta.rows(), 60);
  EXPECT_EQ(c->design.outputs.cols(), 48);
  EXPECT_EQ(c->chains.size(), 4u);
  EXPECT_EQ(c->chains[0].theta.rows(), 17'000);
  EXPECT_EQ(c->thinned.theta.rows(), 270);
  EXPECT_TRUE(c->converged) << (c->findings.empty() ? "" : c->findings.back().sentence);
  EXPECT_EQ(c->hyper_prior.name, "scaled");
  EXPECT_EQ(c->hyper_prior.error_precision.rate, 0.03 * c->normalisation.pooled_variance);
  std::vector<std::string> names;
  for (const Summary& s : c->hyperparameters) names.push_back(s.name);
  EXPECT_THAT(names, ::testing::ElementsAre("lambda_delta", "lambda_eps", "beta_dry_bulb",
                                            "beta_humidity", "beta_out"));
  for (const ChainDraws& chain : c->chains) {
    EXPECT_GE(chain.theta.col(0).minCoeff(), 0.5);
    EXPECT_LE(chain.theta.col(0).maxCoeff(), 2.0);
    EXPECT_GE(chain.beta.minCoeff(), 0.0);
  }
}

TEST(Calibrate, ThreadsDoNotChangeTheBytes) {
  const auto run = [](ForEachIndex executor, std::uint64_t seed) {
    return calibrate(toy_model(1, 12), toy_problem(1, 12), short_options(),
                     {.seed = seed, .executor = std::move(executor)})
        .value();
  };
  const Calibration serial = run(for_each_index_serially, 5);
  const Calibration threaded = run(recald::testing::in_threads, 5);
  const Calibration other = run(for_each_index_serially, 6);
  EXPECT_TRUE(serial.design.theta == threaded.design.theta);
  EXPECT_TRUE(serial.design.outputs == threaded.design.outputs);
  for (std::size_t k = 0; k < serial.chains.size(); ++k) {
    EXPECT_TRUE(serial.chains[k].theta == threaded.chains[k].theta);
    EXPECT_TRUE(serial.chains[k].beta == threaded.chains[k].beta);
  }
  EXPECT_TRUE(serial.thinned.theta == threaded.thinned.theta);
  EXPECT_FALSE(serial.chains[0].theta == other.chains[0].theta);
  EXPECT_FALSE(serial.chains[0].theta == serial.chains[1].theta);
  EXPECT_FALSE(serial.design.theta == other.design.theta);
}

// Chain k depends on (seed, k) only, so asking for more chains leaves the first ones alone.
TEST(Calibrate, MoreChainsLeaveTheFirstOnesAlone) {
  CalibrationOptions options = short_options();
  options.sampling.chains = 2;
  const auto two = calibrate(toy_model(1, 12), toy_problem(1, 12), options, {.seed = 5});
  options.sampling.chains = 3;
  const auto three = calibrate(toy_model(1, 12), toy_problem(1, 12), options, {.seed = 5});
  EXPECT_TRUE(two->chains[1].theta == three->chains[1].theta);
}

TEST(Calibrate, StopsWhenToldAtAnyStep) {
  int calls_in_all = 0;
  CalibrationOptions options = short_options(1000, 500);
  options.design_runs = 20;
  const auto run = [&](int stop_at) {
    calls_in_all = 0;
    return calibrate(
        toy_model(1, 12), toy_problem(1, 12), options,
        {.seed = 1, .observer = [&](const Progress&) { return ++calls_in_all != stop_at; }});
  };
  ASSERT_TRUE(run(-1).has_value());
  const int all = calls_in_all;
  EXPECT_EQ(all, 20 + 4 * 4);
  for (int stop_at = 1; stop_at <= all; ++stop_at) {
    const auto stopped = run(stop_at);
    ASSERT_FALSE(stopped.has_value()) << "at call " << stop_at;
    EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
  }
}

TEST(Calibrate, ReportsStagesInOrder) {
  std::vector<Progress> seen;
  ASSERT_TRUE(calibrate(toy_model(1, 12), toy_problem(1, 12), short_options(),
                        {.seed = 1,
                         .observer =
                             [&](const Progress& p) {
                               seen.push_back(p);
                               return true;
                             }})
                  .has_value());
  EXPECT_EQ(seen.front().stage, Progress::Stage::design);
  EXPECT_EQ(seen[59].done, 60);
  EXPECT_EQ(seen[60].stage, Progress::Stage::sampling);
  EXPECT_EQ(seen.back().chain, 3);
  EXPECT_EQ(seen.back().done, 4000);
}

TEST(Calibrate, AMeterBeyondTheDesignIsFound) {
  CalibrationProblem problem = toy_problem(2, 12);
  // The model itself in the middle of the prior, which the design surrounds, but for one month.
  FunctionModel model = toy_model(2, 12);
  std::vector<double> values(24);
  model.evaluate(std::vector<double>{1.2, 12.5}, values);
  for (std::size_t i = 0; i < 24; ++i) problem.outputs[i / 12].values[i % 12] = values[i];
  problem.outputs[0].values[6] *= 4.0;
  const auto c = calibrate(toy_model(2, 12), problem, short_options(), {.seed = 1});
  ASSERT_TRUE(c.has_value());
  EXPECT_TRUE(has(c->findings, FindingKind::extrapolation, "meter_0"));
  EXPECT_TRUE(has(c->findings, FindingKind::range_fail, "meter_0"));
  EXPECT_FALSE(has(c->findings, FindingKind::range_fail, "meter_1"));
  ASSERT_FALSE(c->range.by_month.empty());
}

// Meters from a building whose balance point lies beyond the prior, and a discrepancy believed
// tiny.
TEST(Calibrate, APosteriorAtTheEdgeOfItsPriorIsFound) {
  CalibrationProblem problem = toy_problem(2, 24);
  problem.parameters[1].prior = {13.0, 15.0, 18.0};
  CalibrationOptions options = short_options();
  options.hyper_prior = make_custom_hyper_prior({10, 1e-4}, {10, 1e-4}, {1, 0.3}).value();
  const auto c = calibrate(toy_model(2, 24), problem, options, {.seed = 1});
  ASSERT_TRUE(c.has_value());
  EXPECT_TRUE(has(c->findings, FindingKind::prior_edge, "balance_point"));
}

TEST(Calibrate, ShortChainsFailTheGateAndSaySo) {
  const CalibrationOptions options = short_options(300, 100);
  const auto c = calibrate(toy_model(2, 12), toy_problem(2, 12), options, {.seed = 1});
  ASSERT_TRUE(c.has_value());
  EXPECT_FALSE(c->converged);
  EXPECT_TRUE(has(c->findings, FindingKind::not_converged, "gain"));
}

TEST(Calibrate, AModelThatBreaksNamesTheParameterValues) {
  const FunctionModel model(2, 1, 12, [](std::span<const double> theta, std::span<double> values) {
    std::fill(values.begin(), values.end(), theta[0]);
    values[3] = theta[1] > 15.0 ? std::numeric_limits<double>::infinity() : 1.0;
  });
  const auto c = calibrate(model, toy_problem(1, 12), short_options(), {.seed = 1});
  ASSERT_FALSE(c.has_value());
  EXPECT_EQ(c.error().code, ErrorCode::not_finite);
  EXPECT_THAT(c.error().message, HasSubstr("output 1, month 4) at gain = "));
  EXPECT_THAT(c.error().message, HasSubstr("balance_point = 1"));
}

TEST(Calibrate, AConstantOutputIsRefused) {
  const FunctionModel model(2, 1, 12, [](std::span<const double>, std::span<double> values) {
    std::fill(values.begin(), values.end(), 7.0);
  });
  const auto c = calibrate(model, toy_problem(1, 12), short_options(), {.seed = 1});
  ASSERT_FALSE(c.has_value());
  EXPECT_EQ(c.error().code, ErrorCode::invalid_value);
  EXPECT_THAT(c.error().message, HasSubstr("7 kWh/day for meter_0 in every run and month"));
}

TEST(Calibrate, AnUnmeasuredOutputIsLeftOut) {
  CalibrationProblem problem = toy_problem(2, 12);
  problem.outputs[1].values.assign(12, std::numeric_limits<double>::quiet_NaN());
  const auto c = calibrate(toy_model(2, 12), problem, short_options(), {.seed = 1});
  ASSERT_TRUE(c.has_value()) << c.error().message;
  EXPECT_EQ(c->hyperparameters.back().name, "beta_humidity");
}

TEST(Calibrate, OptionsOutOfRangeAreRefused) {
  const auto message = [](const CalibrationOptions& options) {
    const auto c = calibrate(toy_model(1, 12), toy_problem(1, 12), options, {.seed = 1});
    EXPECT_FALSE(c.has_value());
    EXPECT_EQ(c.error().code, ErrorCode::invalid_value);
    return c.error().message;
  };
  CalibrationOptions options = short_options();
  options.design_runs = 5;
  EXPECT_THAT(message(options), HasSubstr("at least 20 runs, but only 5"));
  options = short_options();
  options.sampling.chains = 1;
  EXPECT_THAT(message(options), HasSubstr("at least 2 chains"));
  EXPECT_THAT(message(short_options(4000, 4000)), HasSubstr("burn-in is 4000 of 4000"));
  EXPECT_THAT(message(short_options(1004, 1000)), HasSubstr("at least 8 iterations"));
  options = short_options();
  options.thinned_draws = 0;
  EXPECT_THAT(message(options), HasSubstr("at least 1 thinned draw"));
}

TEST(Calibrate, AGivenDesignHasToFit) {
  DesignRuns design{Eigen::MatrixXd::Ones(30, 2), Eigen::MatrixXd::Random(30, 11)};
  const auto wrong = calibrate_on_design(toy_model(1, 12), toy_problem(1, 12), short_options(),
                                         design, {.seed = 1});
  ASSERT_FALSE(wrong.has_value());
  EXPECT_EQ(wrong.error().code, ErrorCode::invalid_value);
  design.outputs = Eigen::MatrixXd::Random(30, 12);
  design.outputs(4, 4) = std::numeric_limits<double>::quiet_NaN();
  const auto broken = calibrate_on_design(toy_model(1, 12), toy_problem(1, 12), short_options(),
                                          design, {.seed = 1});
  ASSERT_FALSE(broken.has_value());
  EXPECT_EQ(broken.error().code, ErrorCode::not_finite);
}

}  // namespace
}  // namespace recald::calibration::calibration_test
