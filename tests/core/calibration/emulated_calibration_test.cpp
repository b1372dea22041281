#include <gtest/gtest.h>

#include <cmath>

#include "core/calibration/calibration.hpp"
#include "tests/core/calibration/sbc_cases.hpp"

namespace recald::calibration::emulated_calibration_test {
namespace {

constexpr int kMonths = 12;

/// The monthly model's chilled water and steam at a truth of its own, with a discrepancy of a few
/// per cent and noise.
CalibrationProblem problem_of(const OwnedSbcCase& epc) {
  CalibrationProblem problem;
  problem.parameters = epc.sbc.parameters;
  problem.inputs = {{"dry_bulb_C"}, epc.sbc.data.month_inputs};
  std::vector<double> theta;
  for (const Parameter& parameter : problem.parameters) {
    theta.push_back(parameter.prior.quantile(0.4));
  }
  const std::vector<double> outputs = evaluate(*epc.model, theta);
  Rng rng{3, 0};
  for (std::size_t k = 0; k < 2; ++k) {
    const double range = epc.sbc.data.scales[k].range();
    OutputMeasurements output{.name = k == 0 ? "cold" : "warm", .unit = "kWh/day"};
    for (std::size_t i = 0; i < kMonths; ++i) {
      output.values.push_back(
          outputs[k * kMonths + i] +
          range * (0.02 * std::sin(0.7 * static_cast<double>(i)) + 0.01 * rng.normal()));
    }
    problem.outputs.push_back(std::move(output));
  }
  for (int i = 0; i < kMonths; ++i) problem.month_names.push_back(std::to_string(i + 1));
  return problem;
}

// The polynomial may not change what is believed: means within a fifth of a posterior sd, sds
// within a fifth. Monte Carlo error is a twentieth of an sd on either side.
TEST(EmulatedCalibration, HasThePosteriorOfTheModelItself) {
  const OwnedSbcCase epc = epc_case(kMonths, 1);
  const CalibrationProblem problem = problem_of(epc);
  CalibrationOptions direct;
  direct.sampling.sampler = find_sampler("dram").value();
  direct.sampling.iterations = 12'000;
  direct.sampling.burn_in = 4'000;
  CalibrationOptions emulated;
  emulated.emulate = true;
  const RunContext context{.seed = 5};
  const auto slow = calibrate(*epc.model, problem, direct, context);
  const auto fast = calibrate(*epc.model, problem, emulated, context);
  ASSERT_TRUE(slow.has_value()) << slow.error().message;
  ASSERT_TRUE(fast.has_value()) << fast.error().message;
  ASSERT_TRUE(fast->emulator_error_sd.has_value());
  EXPECT_FALSE(slow->emulator_error_sd.has_value());
  EXPECT_EQ(fast->sampling.sampler, "nuts");
  EXPECT_TRUE(fast->converged);
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const Summary& a = slow->parameters[j];
    const Summary& b = fast->parameters[j];
    EXPECT_NEAR(b.mean, a.mean, 0.2 * a.sd) << a.name;
    EXPECT_NEAR(b.sd / a.sd, 1.0, 0.2) << a.name;
  }
}

}  // namespace
}  // namespace recald::calibration::emulated_calibration_test
