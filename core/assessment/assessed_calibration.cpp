#include "core/assessment/assessed_calibration.hpp"

#include <algorithm>
#include <cmath>

#include "core/absent.hpp"
#include "core/design/model_runs.hpp"
#include "core/random/streams.hpp"
#include "core/text/number_text.hpp"

namespace recald::assessment {
namespace {

// An output that the whole design moves by less than this share of its mean tells nothing about the
// parameters that Guideline 14's tolerance of ±5 % would not also forgive.
constexpr double kLeastResponse = 0.10;

/// (draws) sd of discrepancy and error together, in the output's unit.
Eigen::VectorXd spread_sds(const calibration::Calibration& calibration, std::size_t output,
                           double weight) {
  const calibration::ThinnedDraws& thinned = calibration.thinned;
  const double range = calibration.normalisation.scales[output].range();
  Eigen::VectorXd sd(static_cast<Eigen::Index>(thinned.chain.size()));
  for (std::size_t d = 0; d < thinned.chain.size(); ++d) {
    const auto& chain = calibration.chains[static_cast<std::size_t>(thinned.chain[d])];
    const int row = thinned.iteration[d];
    const double variance =
        1.0 / chain.discrepancy_precision[row] + 1.0 / chain.error_precision[row];
    // A doubted output has its own share of error on top, as in the likelihood.
    sd[static_cast<Eigen::Index>(d)] = range * std::sqrt(variance / weight);
  }
  return sd;
}

/// (months) known variances of meter and model together.
std::vector<double> known_variances(const OutputCalibration& output) {
  std::vector<double> variances = output.extra_variances;
  variances.resize(output.measured.size(), 0.0);
  for (std::size_t i = 0; i < output.model_variances.size(); ++i) {
    variances[i] += output.model_variances[i];
  }
  return variances;
}

}  // namespace

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

void set_aside_unresponsive(const calibration::DesignRuns& design, AssessedCalibration& result,
                            calibration::CalibrationProblem& problem) {
  const auto months = static_cast<Eigen::Index>(problem.month_names.size());
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    if (problem.outputs[k].measured_months() == 0) continue;
    const auto block = design.outputs.middleCols(static_cast<Eigen::Index>(k) * months, months);
    const double spread = (block.colwise().maxCoeff() - block.colwise().minCoeff()).maxCoeff();
    if (spread > kLeastResponse * std::abs(block.mean())) continue;
    result.outputs[k].calibrated = false;
    std::ranges::fill(problem.outputs[k].values, kAbsent);
    result.warnings.push_back(result.outputs[k].name + ": the calibration parameters move it by " +
                              percent_text(spread / std::abs(block.mean())) +
                              " at most, so it is shown against the model and not fitted.");
  }
}

Result<void> calibrate_into(const MonthlyModel& model,
                            const calibration::CalibrationProblem& problem,
                            const calibration::CalibrationOptions& options, bool prior_sensitivity,
                            calibration::DesignRuns design, const calibration::RunContext& context,
                            AssessedCalibration& result) {
  auto calibrated =
      calibration::calibrate_on_design(model, problem, options, std::move(design), context);
  if (!calibrated) return tl::unexpected(calibrated.error());
  result.calibration = std::move(*calibrated);
  for (const calibration::Finding& finding : result.calibration.findings) {
    result.warnings.push_back(finding.sentence);
  }
  if (!prior_sensitivity) return {};
  auto sensitivity =
      calibration::prior_sensitivity(model, problem, options, result.calibration, context);
  if (!sensitivity) return tl::unexpected(sensitivity.error());
  result.sensitivity = std::move(*sensitivity);
  for (const calibration::Finding& finding : result.sensitivity->findings) {
    result.warnings.push_back(finding.sentence);
  }
  return {};
}

Result<void> assess(MonthlyModel& whole_model, const calibration::RunContext& context,
                    AssessedCalibration& result) {
  const std::vector<double> at_modes = evaluate(whole_model, prior_modes(result.parameters));
  const std::vector<double> at_means = evaluate(whole_model, prior_means(result.parameters));
  const Eigen::VectorXd& mean = result.calibration.posterior_mean;
  const std::vector<double> after =
      evaluate(whole_model, {mean.data(), static_cast<std::size_t>(mean.size())});
  const auto draws = design::run_model(whole_model, result.parameters,
                                       result.calibration.thinned.theta, context.executor);
  if (!draws) return tl::unexpected(draws.error());

  const std::size_t n = result.month_names.size();
  Rng rng{context.seed, streams::kPredictive.first};
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    OutputCalibration& output = result.outputs[k];
    const auto part = [&](const std::vector<double>& all) {
      return std::span{all}.subspan(k * n, n);
    };
    const Eigen::MatrixXd simulated =
        draws->middleCols(static_cast<Eigen::Index>(k * n), static_cast<Eigen::Index>(n));
    const Eigen::VectorXd spread = output.calibrated
                                       ? spread_sds(result.calibration, k, output.weight)
                                       : Eigen::VectorXd::Zero(simulated.rows()).eval();
    output.assessment = assess_output(
        output.measured, result.roles,
        {.prior_mode = part(at_modes),
         .prior_mean = part(at_means),
         .posterior_mean = part(after),
         .draws = simulated,
         .predictive = add_discrepancy_and_error(simulated, spread, known_variances(output), rng)});
  }
  return {};
}

}  // namespace recald::assessment
