#include "core/calibration/sensitivity.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/display/id_words.hpp"
#include "core/text/number_text.hpp"

namespace recald::calibration {
namespace {

constexpr double kMoveMax = 0.5;  // posterior standard deviations

Result<Calibration> rerun(const MonthlyModel& prototype, const CalibrationProblem& problem,
                          CalibrationOptions options, const Calibration& base,
                          const RunContext& context, double mean_factor) {
  HyperPrior prior = base.hyper_prior;
  prior.name += ", lambda_delta prior mean x " + number_text(mean_factor);
  prior.discrepancy_precision.rate /= mean_factor;
  options.hyper_prior = prior;
  options.predictive = false;
  return calibrate_on_design(prototype, problem, options, base.design, context);
}

Finding prior_driven(const Summary& base, const ParameterSensitivity& s, double factor) {
  return {
      FindingKind::prior_driven, base.name,
      display::capitalised(display::parameter_words(base.name)) +
          " is prior-driven: the data do not determine it.",
      "Its posterior mean moves by up to " + number_text(s.largest_move_sd, 2) +
          " posterior standard deviations if the prior mean of the discrepancy's precision is " +
          number_text(factor) + " times larger and smaller."};
}

void keep_unconverged(const Calibration& run, Findings& findings) {
  std::copy_if(run.findings.begin(), run.findings.end(), std::back_inserter(findings),
               [](const Finding& f) { return f.kind == FindingKind::not_converged; });
}

}  // namespace

Result<PriorSensitivity> prior_sensitivity(const MonthlyModel& prototype,
                                           const CalibrationProblem& problem,
                                           const CalibrationOptions& options,
                                           const Calibration& base, const RunContext& context,
                                           double factor) {
  assert(factor > 1.0 && base.parameters.size() == problem.parameters.size());
  const auto smaller = TRY(rerun(prototype, problem, options, base, context, factor));
  const auto larger = TRY(rerun(prototype, problem, options, base, context, 1.0 / factor));

  PriorSensitivity result{factor, {}, {}};
  for (std::size_t j = 0; j < base.parameters.size(); ++j) {
    const Summary& before = base.parameters[j];
    const double a = smaller.parameters[j].mean;
    const double b = larger.parameters[j].mean;
    const double move = std::max(std::abs(a - before.mean), std::abs(b - before.mean)) / before.sd;
    const ParameterSensitivity parameter{a, b, move, move > kMoveMax};
    if (parameter.prior_driven) {
      result.findings.push_back(prior_driven(before, parameter, factor));
    }
    result.parameters.push_back(parameter);
  }
  keep_unconverged(smaller, result.findings);
  keep_unconverged(larger, result.findings);
  return result;
}

}  // namespace recald::calibration
