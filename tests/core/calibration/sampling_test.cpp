#include "core/calibration/sampling.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/core/calibration/small_case.hpp"
#include "tests/core/calibration/toy_models.hpp"

namespace recald::calibration {
namespace {

using ::testing::HasSubstr;

constexpr double kOneHill = 0.03;
constexpr double kTwoHills = 0.065;

SamplingOptions with(std::string_view sampler) {
  SamplingOptions options;
  if (!sampler.empty()) options.sampler = find_sampler(sampler).value();
  return options;
}

Result<SampledPosterior> sample(double wave, const SamplingOptions& options,
                                std::uint64_t seed = 1) {
  return sample_posterior(small_posterior(wave), {"x"}, options, {.seed = seed});
}

std::vector<Summary> all_summaries(const SampledPosterior& sampled) {
  std::vector<Summary> all = sampled.parameters;
  all.insert(all.end(), sampled.hyperparameters.begin(), sampled.hyperparameters.end());
  return all;
}

/// Draws in the coordinates of the quadrature, (draws x chains).
Eigen::MatrixXd in_coordinates(const SampledPosterior& sampled, Eigen::Index coordinate) {
  Eigen::MatrixXd draws(sampled.report.kept, static_cast<Eigen::Index>(sampled.chains.size()));
  for (std::size_t k = 0; k < sampled.chains.size(); ++k) {
    const ChainDraws& chain = sampled.chains[k];
    const auto column = static_cast<Eigen::Index>(k);
    if (coordinate == 1) draws.col(column) = chain.discrepancy_precision.array().log();
    if (coordinate == 2) draws.col(column) = chain.error_precision.array().log();
    if (coordinate == 3) draws.col(column) = chain.beta.col(0);
  }
  return draws;
}

class EverySampler : public ::testing::TestWithParam<std::string> {};

// The answer comes from the trapezoid rule on a grid, not from another sampler.
TEST_P(EverySampler, ReproducesQuadrature) {
  static const Quadrature exact = integrate(small_posterior(kOneHill), {30, 16, 28, 44});
  const auto sampled = sample(kOneHill, with(GetParam()));
  ASSERT_TRUE(sampled.has_value()) << sampled.error().message;
  EXPECT_TRUE(sampled->converged);
  for (Eigen::Index c = 1; c <= 2; ++c) {
    const Eigen::MatrixXd draws = in_coordinates(*sampled, c);
    const Diagnostics d = diagnose(draws);
    EXPECT_GE(d.ess_bulk, 400.0);
    EXPECT_NEAR(draws.mean(), exact.mean(c), 4.0 * d.mcse) << "coordinate " << c;
    const Eigen::MatrixXd squares = (draws.array() - exact.mean(c)).square();
    EXPECT_NEAR(squares.mean(), exact.sd(c) * exact.sd(c), 4.0 * diagnose(squares).mcse);
  }
}

INSTANTIATE_TEST_SUITE_P(ByName, EverySampler,
                         ::testing::Values("", "nuts", "dram", "smc", "seed_rwm"),
                         [](const auto& given) {
                           return given.param.empty() ? std::string{"left_to_itself"} : given.param;
                         });

// Smooth discrepancy and much noise, or a wiggly one and little: two hills with nothing between.
// Whatever is the default has to weigh them, or to say that it could not.
TEST(SamplePosterior, WeighsTwoSeparateHills) {
  const Quadrature exact = integrate(small_posterior(kTwoHills), {30, 16, 28, 44});
  ASSERT_NEAR(exact.below, 0.311, 0.005);
  // rho's score of -2 as a beta.
  const double valley = small_posterior(kTwoHills).prior().rho.at_score(-2.0).beta;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const auto sampled = sample(kTwoHills, with(""), seed);
    ASSERT_TRUE(sampled.has_value());
    EXPECT_TRUE(sampled->converged);
    const Eigen::MatrixXd wiggly = (in_coordinates(*sampled, 3).array() > valley).cast<double>();
    const double mcse = diagnose(wiggly).mcse;
    EXPECT_LT(mcse, 0.03);
    EXPECT_NEAR(wiggly.mean(), exact.below, 4.0 * mcse);
    for (const Summary& s : all_summaries(*sampled)) EXPECT_LE(s.rhat, 1.01) << s.name;
    EXPECT_NEAR(sampled->report.log_evidence, exact.log_evidence,
                std::max(0.1, 4.0 * sampled->report.log_evidence_se));
  }
}

TEST(SamplePosterior, SaysWhichSamplerTookOver) {
  const auto sampled = sample(kTwoHills, with(""), 1);
  ASSERT_TRUE(sampled.has_value());
  EXPECT_EQ(sampled->report.sampler, "smc");
  EXPECT_THAT(sampled->report.taken_over, HasSubstr("nuts was abandoned"));
  const auto finding =
      std::find_if(sampled->findings.begin(), sampled->findings.end(),
                   [](const Finding& f) { return f.kind == FindingKind::sampler_replaced; });
  ASSERT_NE(finding, sampled->findings.end());
  EXPECT_THAT(finding->sentence, HasSubstr("replaced the chains"));
  EXPECT_TRUE(sample(kOneHill, with(""))->report.taken_over.empty());
}

TEST(SamplePosterior, ASamplerAskedForByNameIsNotReplaced) {
  SamplingOptions options = with("nuts");
  options.doublings_max = 0;
  const auto sampled = sample(kTwoHills, options, 2);
  ASSERT_TRUE(sampled.has_value());
  EXPECT_EQ(sampled->report.sampler, "nuts");
  EXPECT_TRUE(sampled->report.taken_over.empty());
  EXPECT_FALSE(sampled->converged);
}

TEST(SamplePosterior, ChoosesDramWithoutAGradient) {
  const Posterior posterior =
      Posterior::make(toy_model(1, 12), toy_parameters(),
                      normalise_problem(toy_problem(1, 12), {{{400.0, 2500.0}}, 0.05}),
                      make_hyper_prior(HyperPriorProfile::scaled, 0.05))
          .value();
  const auto sampled = sample_posterior(posterior, {"dry_bulb", "humidity"}, {}, {.seed = 1});
  ASSERT_TRUE(sampled.has_value());
  EXPECT_EQ(sampled->report.sampler, "dram");
  EXPECT_EQ(sampled->report.gradient_evaluations, 0);
  const auto refused =
      sample_posterior(posterior, {"dry_bulb", "humidity"}, with("nuts"), {.seed = 1});
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
  EXPECT_THAT(refused.error().message, HasSubstr("choose dram, smc or seed_rwm"));
}

TEST(SamplePosterior, DoublesTheDrawsTwiceAndThenGivesUp) {
  SamplingOptions options = with("nuts");
  options.gate.ess_min = 1e9;
  const auto sampled = sample(kOneHill, options);
  ASSERT_TRUE(sampled.has_value());
  EXPECT_FALSE(sampled->converged);
  EXPECT_EQ(sampled->report.doublings, 2);
  EXPECT_EQ(sampled->report.kept, 4 * 1000);
  EXPECT_EQ(sampled->chains[3].theta.rows(), 4000);
  EXPECT_FALSE(sampled->findings.empty());
}

TEST(SamplePosterior, DrawsThatWereAskedForAreNeitherDoubledNorReplaced) {
  SamplingOptions options = with("");
  options.iterations = 300;
  options.burn_in = 100;
  const auto sampled = sample(kTwoHills, options);
  ASSERT_TRUE(sampled.has_value());
  EXPECT_EQ(sampled->report.sampler, "nuts");
  EXPECT_EQ(sampled->report.kept, 200);
  EXPECT_FALSE(sampled->converged);
  EXPECT_FALSE(sampled->findings.empty());
}

// What was drawn before a doubling stays as it was: the longer chain begins with the shorter one.
TEST(SamplePosterior, ADoubledChainContinuesItself) {
  SamplingOptions options = with("nuts");
  options.doublings_max = 0;
  const auto once = sample(kOneHill, options);
  options.doublings_max = 1;
  options.gate.ess_min = 1e9;
  const auto twice = sample(kOneHill, options);
  ASSERT_TRUE(once.has_value() && twice.has_value());
  EXPECT_TRUE(once->chains[1].theta == twice->chains[1].theta.topRows(1000));
  EXPECT_EQ(twice->chains[1].theta.rows(), 2000);
}

TEST(SamplePosterior, StopsWhenToldAtAnyStep) {
  SamplingOptions options = with("");
  options.iterations = 60;
  options.burn_in = 30;
  int calls = 0;
  const auto run = [&](int stop_at) {
    calls = 0;
    return sample_posterior(
        small_posterior(kOneHill), {"x"}, options,
        {.seed = 1, .observer = [&](const Progress&) { return ++calls != stop_at; }});
  };
  ASSERT_TRUE(run(-1).has_value());
  const int all = calls;
  ASSERT_GT(all, 20);
  for (int stop_at = 1; stop_at <= all; stop_at += 1 + all / 40) {
    const auto stopped = run(stop_at);
    ASSERT_FALSE(stopped.has_value()) << "at call " << stop_at;
    EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
  }
}

TEST(SamplePosterior, EvidenceAgreesWithQuadrature) {
  const Quadrature exact = integrate(small_posterior(kOneHill), {30, 16, 28, 44});
  const auto sampled = sample(kOneHill, with("smc"));
  ASSERT_TRUE(sampled.has_value());
  EXPECT_NEAR(sampled->report.log_evidence, exact.log_evidence, 0.1);
  EXPECT_LT(sampled->report.log_evidence_se, 0.1);
}

TEST(SamplePosterior, RefusesOptionsThatMakeNoSense) {
  const auto message = [](const SamplingOptions& options) {
    const auto sampled = sample(kOneHill, options);
    EXPECT_FALSE(sampled.has_value());
    EXPECT_EQ(sampled.error().code, ErrorCode::invalid_value);
    return sampled.error().message;
  };
  SamplingOptions options;
  options.chains = 1;
  EXPECT_THAT(message(options), HasSubstr("at least 2 chains"));
  options = with("dram");
  options.iterations = 100;
  options.burn_in = 100;
  EXPECT_THAT(message(options), HasSubstr("burn-in is 100 of 100"));
  options.iterations = 104;
  EXPECT_THAT(message(options), HasSubstr("at least 8 iterations"));
  options = with("smc");
  options.burn_in = 10;
  EXPECT_THAT(message(options), HasSubstr("smc has no burn-in"));
}

}  // namespace
}  // namespace recald::calibration
