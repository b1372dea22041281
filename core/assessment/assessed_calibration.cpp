#include "core/assessment/assessed_calibration.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/absent.hpp"
#include "core/assessment/given_data.hpp"
#include "core/assessment/pooled_forecasts.hpp"
#include "core/design/model_runs.hpp"
#include "core/text/number_text.hpp"

namespace recald::assessment {
namespace {

// An output that the whole design moves by less than this share of its mean tells nothing about the
// parameters that Guideline 14's tolerance of ±5 % would not also forgive.
constexpr double kLeastResponse = 0.10;

}  // namespace

std::vector<double> known_variances(const OutputCalibration& output) {
  std::vector<double> variances = output.extra_variances;
  variances.resize(output.measured.size(), 0.0);
  for (std::size_t i = 0; i < output.model_variances.size(); ++i) {
    variances[i] += output.model_variances[i];
  }
  return variances;
}

calibration::CalibrationProblem problem_of(const AssessedCalibration& result,
                                           std::size_t calibration_months) {
  calibration::CalibrationProblem problem;
  problem.parameters = result.parameters;
  const auto n = static_cast<std::ptrdiff_t>(calibration_months);
  problem.month_names = {result.month_names.begin(), result.month_names.begin() + n};
  const auto leading = [n](const std::vector<double>& values) {
    if (values.empty()) return values;
    return std::vector<double>{values.begin(), values.begin() + n};
  };
  for (const OutputCalibration& output : result.outputs) {
    problem.outputs.push_back({.name = output.name,
                               .unit = output.unit,
                               .values = leading(output.measured),
                               .extra_variances = leading(output.extra_variances),
                               .weight = output.weight});
  }
  return problem;
}

void set_aside(std::size_t output, std::string because, Following following,
               AssessedCalibration& result, calibration::CalibrationProblem& problem) {
  result.outputs[output].calibrated = false;
  result.outputs[output].following = following;
  result.outputs[output].not_fitted_because = std::move(because);
  std::ranges::fill(problem.outputs[output].values, kAbsent);
}

void set_aside_unresponsive(const calibration::DesignRuns& design, AssessedCalibration& result,
                            calibration::CalibrationProblem& problem) {
  const auto months = static_cast<Eigen::Index>(problem.month_names.size());
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    if (problem.outputs[k].measured_months() == 0) continue;
    const auto block = design.outputs.middleCols(static_cast<Eigen::Index>(k) * months, months);
    const double spread = (block.colwise().maxCoeff() - block.colwise().minCoeff()).maxCoeff();
    if (spread > kLeastResponse * std::abs(block.mean())) continue;
    set_aside(k,
              "The calibration parameters move it by " +
                  percent_text(spread / std::abs(block.mean())) + " at most.",
              Following::level, result, problem);
  }
}

Result<void> calibrate_into(const MonthlyModel& model,
                            const calibration::CalibrationProblem& problem,
                            const calibration::CalibrationOptions& options, bool prior_sensitivity,
                            calibration::DesignRuns design, const calibration::RunContext& context,
                            AssessedCalibration& result) {
  result.calibration =
      TRY(calibration::calibrate_on_design(model, problem, options, std::move(design), context));
  for (const calibration::Finding& finding : result.calibration.findings) {
    const bool is_alarm = finding.kind == calibration::FindingKind::prior_edge;
    (is_alarm ? result.alarms : result.warnings).push_back(warning_of(finding));
  }
  if (!prior_sensitivity) return {};
  auto sensitivity =
      TRY(calibration::prior_sensitivity(model, problem, options, result.calibration, context));
  result.sensitivity = std::move(sensitivity);
  for (const calibration::Finding& finding : result.sensitivity->findings) {
    result.warnings.push_back(warning_of(finding));
  }
  return {};
}

Result<void> assess(MonthlyModel& whole_model, const WholePeriod& whole,
                    std::span<const std::optional<OutputForecasts>> yardsticks,
                    const calibration::RunContext& context, AssessedCalibration& result) {
  assert(yardsticks.empty() || yardsticks.size() == result.outputs.size());
  const std::vector<double> at_modes = evaluate(whole_model, prior_modes(result.parameters));
  const std::vector<double> at_means = evaluate(whole_model, prior_means(result.parameters));
  const Eigen::VectorXd& mean = result.calibration.posterior_mean;
  const std::vector<double> after =
      evaluate(whole_model, {mean.data(), static_cast<std::size_t>(mean.size())});
  const auto draws = TRY(design::run_model(
      whole_model, result.parameters, result.calibration.thinned.theta, context.executor,
      calibration::of_runs(context, calibration::Progress::Stage::predicting)));
  scale_followed(result);
  auto forecasts = TRY(forecast_given_data(result, whole, draws));

  const std::size_t n = result.month_names.size();
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    OutputCalibration& output = result.outputs[k];
    OutputForecasts& forecast = forecasts[k];
    adapt_to_scatter(result, k, forecast);
    const OutputForecasts* yardstick =
        yardsticks.empty() || !yardsticks[k] ? nullptr : &*yardsticks[k];
    double model_weight = 1.0;
    std::optional<ForecastAssessment> by_model;
    if (yardstick != nullptr) {
      by_model = assess_forecasts(output.measured, result.roles, forecast, result.month_days);
      forecast = pool(forecast, *yardstick, output.measured, model_weight);
    }
    const auto part = [&](const std::vector<double>& all) {
      return std::span{all}.subspan(k * n, n);
    };
    output.assessment = assess_output(
        output.measured, result.roles,
        {.prior_mode = part(at_modes),
         .prior_mean = part(at_means),
         .posterior_mean = part(after),
         .draws = draws.middleCols(static_cast<Eigen::Index>(k * n), static_cast<Eigen::Index>(n))},
        forecast, result.month_days);
    output.assessment.model_weight = model_weight;
    output.assessment.by_model = std::move(by_model);
    if (yardstick == nullptr) continue;
    output.assessment.yardstick =
        assess_forecasts(output.measured, result.roles, *yardstick, result.month_days);
  }
  return {};
}

}  // namespace recald::assessment
