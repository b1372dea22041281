#include "core/calibration/posterior/problem.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/core/calibration/toy_models.hpp"

namespace recald::calibration::problem_test {
namespace {

using ::testing::HasSubstr;
const double kMissing = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

TEST(CalibrationProblem, ASoundOnePasses) {
  const auto ok = check_problem(toy_problem(2, 12), toy_model(2, 12));
  EXPECT_TRUE(ok.has_value()) << ok.error().message;
}

struct Fault {
  const char* name;
  std::function<void(CalibrationProblem&)> make;
  ErrorCode code;
  const char* says;
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

class FaultyProblem : public ::testing::TestWithParam<Fault> {};

TEST_P(FaultyProblem, IsExplainedInOneSentence) {
  CalibrationProblem problem = toy_problem(2, 12);
  GetParam().make(problem);

  const auto result = check_problem(problem, toy_model(2, 12));

  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, GetParam().code);
  EXPECT_THAT(result.error().message, HasSubstr(GetParam().says));
}

const Fault kFaults[] = {
    {"weight_zero", [](CalibrationProblem& p) { p.outputs[1].weight = 0.0; },
     ErrorCode::invalid_value, "the weight of meter_1 is 0"},
    {"weight_above_one", [](CalibrationProblem& p) { p.outputs[0].weight = 1.5; },
     ErrorCode::invalid_value, "the weight of meter_0 is 1.5"},
    {"weight_nan", [](CalibrationProblem& p) { p.outputs[0].weight = kMissing; },
     ErrorCode::invalid_value, "the weight of meter_0"},
    {"parameter_missing", [](CalibrationProblem& p) { p.parameters.pop_back(); },
     ErrorCode::invalid_value, "2 calibration parameters, but 1 are given"},
    {"output_missing", [](CalibrationProblem& p) { p.outputs.pop_back(); },
     ErrorCode::invalid_value, "2 outputs, but 1 are given"},
    {"month_missing", [](CalibrationProblem& p) { p.month_names.pop_back(); },
     ErrorCode::invalid_value, "12 months, but 11 are given"},
    {"value_missing", [](CalibrationProblem& p) { p.outputs[0].values.pop_back(); },
     ErrorCode::invalid_value, "meter_0 needs one value"},
    {"value_infinite", [](CalibrationProblem& p) { p.outputs[0].values[3] = kInfinity; },
     ErrorCode::not_finite, "measured meter_0 of month 4 is infinite"},
    {"variance_negative",
     [](CalibrationProblem& p) {
       p.outputs[0].extra_variances.assign(12, 0.0);
       p.outputs[0].extra_variances[1] = -2.0;
     },
     ErrorCode::invalid_value, "extra variance of measured meter_0 of month 2 is -2"},
    {"variances_too_few", [](CalibrationProblem& p) { p.outputs[0].extra_variances = {1.0}; },
     ErrorCode::invalid_value, "meter_0 needs one value, and one extra variance or none"},
    {"model_error_negative",
     [](CalibrationProblem& p) {
       p.model_error_sd = Eigen::VectorXd::Constant(24, 0.1);
       p.model_error_sd(7) = -0.1;
     },
     ErrorCode::invalid_value, "the model's own error"},
    {"model_error_short",
     [](CalibrationProblem& p) { p.model_error_sd = Eigen::VectorXd::Ones(2); },
     ErrorCode::invalid_value, "for each output and month"},
    {"common_error_short",
     [](CalibrationProblem& p) { p.common_errors.push_back(Eigen::VectorXd::Ones(12)); },
     ErrorCode::invalid_value, "a common error needs a finite value for each of the 24"},
    {"input_constant", [](CalibrationProblem& p) { p.inputs.values.col(1).setConstant(50.0); },
     ErrorCode::invalid_value, "the model input humidity is 50 in every month"},
    {"input_nan", [](CalibrationProblem& p) { p.inputs.values(4, 0) = kMissing; },
     ErrorCode::not_finite, "the model input dry_bulb of month 5 is missing"},
    {"no_input", [](CalibrationProblem& p) { p.inputs = {}; }, ErrorCode::invalid_value,
     "at least one model input"},
    {"too_few_points",
     [](CalibrationProblem& p) {
       for (auto& output : p.outputs) {
         for (std::size_t i = 1; i < 12; ++i) output.values[i] = kMissing;
       }
     },
     ErrorCode::not_enough_data, "needs at least 4 usable monthly figures, but there are 2"},
};

INSTANTIATE_TEST_SUITE_P(Each, FaultyProblem, ::testing::ValuesIn(kFaults),
                         [](const auto& param) { return std::string(param.param.name); });

TEST(CalibrationProblem, NormalisesValuesVariancesAndCommonErrors) {
  CalibrationProblem problem = toy_problem(2, 12);
  problem.outputs[0].values[3] = kMissing;
  problem.outputs[1].extra_variances.assign(12, 25.0);
  problem.model_error_sd = Eigen::VectorXd::Zero(24);
  problem.model_error_sd.tail(12).setConstant(12.0);
  problem.model_error_sd(13) = 24.0;
  problem.common_errors = {Eigen::VectorXd::Constant(24, 5.0)};
  const Normalisation normalisation{{{100.0, 300.0}, {50.0, 60.0}}, 0.05};

  const PosteriorData data = normalise_problem(problem, normalisation);

  ASSERT_EQ(data.points.size(), 23u);
  EXPECT_EQ(data.points[3].month, 4);
  EXPECT_DOUBLE_EQ(data.values(0), (problem.outputs[0].values[0] - 100.0) / 200.0);
  EXPECT_EQ(data.extra_variances(0), 0.0);
  EXPECT_DOUBLE_EQ(data.extra_variances(11), (25.0 + 144.0) / 100.0);
  EXPECT_DOUBLE_EQ(data.extra_variances(12), (25.0 + 576.0) / 100.0);
  EXPECT_DOUBLE_EQ(data.common_errors(0, 0), 5.0 / 200.0);
  EXPECT_DOUBLE_EQ(data.common_errors(11, 0), 5.0 / 10.0);
  EXPECT_DOUBLE_EQ(data.month_inputs.minCoeff(), 0.0);
  EXPECT_DOUBLE_EQ(data.month_inputs.maxCoeff(), 1.0);
}

TEST(CalibrationProblem, WeightsAreRelativeToTheLargestMeasuredOne) {
  CalibrationProblem problem = toy_problem(2, 12);
  problem.outputs[0].weight = 0.2;
  problem.outputs[1].weight = 0.8;
  const Normalisation normalisation{{{0.0, 1.0}, {0.0, 1.0}}, 0.05};
  EXPECT_EQ(normalise_problem(problem, normalisation).weights, (std::vector<double>{0.25, 1.0}));

  problem.outputs[1].values.assign(12, kMissing);
  EXPECT_EQ(normalise_problem(problem, normalisation).weights, (std::vector<double>{1.0, 1.0}));
}

}  // namespace
}  // namespace recald::calibration::problem_test
