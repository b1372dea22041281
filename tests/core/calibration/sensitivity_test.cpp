#include "core/calibration/sensitivity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/calibration/toy_models.hpp"

namespace recald::calibration::sensitivity_test {
namespace {

CalibrationOptions options() {
  CalibrationOptions options;
  options.design_runs = 60;
  options.sampling.sampler = find_sampler("seed_rwm").value();
  options.sampling.iterations = 12'000;
  options.sampling.burn_in = 2'000;
  options.sampling.doublings_max = 0;
  return options;
}

PriorSensitivity sensitivity_of(const CalibrationProblem& problem, HyperPriorProfile profile) {
  CalibrationOptions chosen = options();
  chosen.hyper_prior = profile;
  const FunctionModel model = toy_model(static_cast<int>(problem.outputs.size()),
                                        static_cast<int>(problem.month_names.size()));
  const auto base = calibrate(model, problem, chosen, {.seed = 2});
  EXPECT_TRUE(base.has_value());
  return prior_sensitivity(model, problem, chosen, *base, {.seed = 2}).value();
}

TEST(PriorSensitivity, DataThatDetermineAParameterLeaveLittleToThePrior) {
  const PriorSensitivity s = sensitivity_of(toy_problem(2, 24), HyperPriorProfile::scaled);
  ASSERT_EQ(s.parameters.size(), 2u);
  EXPECT_FALSE(s.parameters[1].prior_driven);
  EXPECT_LT(s.parameters[1].largest_move_sd, 0.5);
}

// Few months, far from the prior mean: a small discrepancy forces the parameters there, a large one
// explains the gap itself and leaves them near the prior. Which it is, is belief.
TEST(PriorSensitivity, AGapThatEitherCanExplainIsPriorDriven) {
  CalibrationProblem problem = toy_problem(1, 6);
  FunctionModel model = toy_model(1, 6);
  model.evaluate(std::vector<double>{1.9, 9.0}, problem.outputs[0].values);
  const PriorSensitivity s = sensitivity_of(problem, HyperPriorProfile::seed);
  const bool any = std::any_of(s.parameters.begin(), s.parameters.end(),
                               [](const ParameterSensitivity& p) { return p.prior_driven; });
  ASSERT_TRUE(any);
  const auto finding = std::find_if(s.findings.begin(), s.findings.end(), [](const Finding& f) {
    return f.kind == FindingKind::prior_driven;
  });
  ASSERT_NE(finding, s.findings.end());
  EXPECT_THAT(finding->sentence, ::testing::HasSubstr("is prior-driven"));
}

TEST(PriorSensitivity, CanBeCancelled) {
  const FunctionModel model = toy_model(2, 24);
  const CalibrationProblem problem = toy_problem(2, 24);
  const auto base = calibrate(model, problem, options(), {.seed = 2});
  const auto stopped =
      prior_sensitivity(model, problem, options(), *base,
                        {.seed = 2, .observer = [](const Progress&) { return false; }});
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace recald::calibration::sensitivity_test
