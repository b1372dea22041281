#include "core/calibration/calibration.hpp"

#include <algorithm>
#include <utility>

#include "core/calibration/posterior/emulator.hpp"
#include "core/calibration/posterior/posterior.hpp"
#include "core/calibration/posterior_findings.hpp"
#include "core/calibration/samplers/chain_loop.hpp"
#include "core/design/latin_hypercube.hpp"
#include "core/design/model_runs.hpp"
#include "core/random/streams.hpp"

namespace recald::calibration {
namespace {

constexpr int kDesignRunsMin = 20;

Result<void> check_calibration_options(const CalibrationOptions& options) {
  if (options.thinned_draws < 1) {
    return failure(ErrorCode::invalid_value, "at least 1 thinned draw must be requested");
  }
  return check_sampling(options.sampling);
}

HyperPrior chosen_hyper_prior(const CalibrationOptions& options, double pooled_variance) {
  if (const auto* own = std::get_if<HyperPrior>(&options.hyper_prior)) return *own;
  return make_hyper_prior(std::get<HyperPriorProfile>(options.hyper_prior), pooled_variance);
}

Result<void> check_design(const DesignRuns& design, const CalibrationProblem& problem) {
  const auto columns =
      static_cast<Eigen::Index>(problem.outputs.size() * problem.month_names.size());
  const bool fits = design.outputs.rows() >= 2 && design.outputs.cols() == columns &&
                    design.theta.rows() == design.outputs.rows();
  if (fits && design.outputs.allFinite()) return {};
  return failure(fits ? ErrorCode::not_finite : ErrorCode::invalid_value,
                 "the design needs at least 2 runs, each with a finite value for each of the " +
                     std::to_string(columns) + " outputs and months");
}

void add_posterior_findings(const CalibrationProblem& problem, Calibration& c) {
  append(c.findings, edge_findings(problem.parameters, c.chains));
  append(c.findings, conflict_findings(c.hyperparameters[0], c.hyper_prior.discrepancy_precision));
  append(c.findings, conflict_findings(c.hyperparameters[1], c.hyper_prior.error_precision));
}

/// Checks the posterior beyond its draws. None of these is required: whatever fails is left out.
/// @return cancelled.
Result<void> check_model(const Posterior& prototype, const Eigen::MatrixXd& points,
                         const CalibrationProblem& problem, const RunContext& context,
                         Calibration& c) {
  Posterior posterior(prototype);
  Rng rng(context.seed, streams::kBridge.first);
  // A model that is slow is evaluated some thousand times more.
  const std::function<bool()> proceed = [&, observed_s = worked_s()]() mutable {
    if (worked_s() - observed_s < kObserveWithin_s) return true;
    observed_s = worked_s();
    return !context.observer || context.observer({Progress::Stage::predicting, 0, 0, 1});
  };
  const auto is_cancelled = [](const auto& result) {
    return !result && result.error().code == ErrorCode::cancelled;
  };
  const auto evidence = bridge_log_evidence(posterior, points, rng, proceed);
  if (is_cancelled(evidence)) return tl::unexpected(evidence.error());
  if (evidence) c.evidence = *evidence;
  append(c.findings, evidence_findings(c.sampling, c.evidence));
  for (const int months : {1, 3}) {
    const auto score = leave_out_score(posterior, c.chains, months, kLeaveOutDraws, proceed);
    if (is_cancelled(score)) return tl::unexpected(score.error());
    if (score) c.leave_out.push_back(*score);
  }
  c.weak_directions = find_weak_directions(posterior, c.chains, c.posterior_mean);
  append(c.findings, weak_direction_findings(c.weak_directions, problem.parameters));
  append(c.findings, discrepancy_findings(problem.outputs, c.normalisation, c.chains));
  return {};
}

/// The emulator that is sampled instead of a model without derivatives; absent: the model
/// itself is sampled.
std::optional<Emulator> emulator_of(const MonthlyModel& prototype, const DesignRuns& design,
                                    const CalibrationOptions& options) {
  if (!options.emulate || prototype.has_jacobian()) return {};
  auto emulator =
      emulate(design.theta, design.outputs, prototype.output_count(), prototype.month_count());
  if (!emulator) return {};  // too few runs for this many parameters
  return std::move(*emulator);
}

}  // namespace

design::RunObserver of_runs(const RunContext& context, Progress::Stage stage) {
  if (!context.observer) return {};
  return [&context, stage](int done, int total) {
    return context.observer({stage, 0, done, total});
  };
}

Result<DesignRuns> run_design(const MonthlyModel& prototype, const CalibrationProblem& problem,
                              int runs, const RunContext& context) {
  if (runs < kDesignRunsMin) {
    return failure(ErrorCode::invalid_value,
                   "a design needs at least " + std::to_string(kDesignRunsMin) +
                       " runs, but only " + std::to_string(runs) + " were requested");
  }
  Rng rng(context.seed, streams::kDesign.first);
  DesignRuns design;
  design.theta = design::latin_hypercube(problem.parameters, runs, rng);
  design.outputs = TRY(design::run_model(prototype, problem.parameters, design.theta,
                                         context.executor, of_runs(context)));
  return design;
}

Result<Calibration> calibrate_on_design(const MonthlyModel& prototype,
                                        const CalibrationProblem& problem,
                                        const CalibrationOptions& options, DesignRuns design,
                                        const RunContext& context) {
  TRY(check_problem(problem, prototype));
  TRY(check_calibration_options(options));
  TRY(check_design(design, problem));
  auto normalisation =
      TRY(normalise_design(design.outputs, problem.outputs, prototype.month_count()));

  Calibration result{};
  result.seed = context.seed;
  result.design = std::move(design);
  result.normalisation = std::move(normalisation);
  result.range = check_range(result.design.outputs, problem.outputs, result.normalisation);
  result.findings = range_findings(result.range, problem.outputs, problem.month_names);
  result.hyper_prior = chosen_hyper_prior(options, result.normalisation.pooled_variance);

  PosteriorData data = normalise_problem(problem, result.normalisation);
  const auto emulator = emulator_of(prototype, result.design, options);
  if (emulator) {
    add_emulator_error(emulator->error_sd, prototype.month_count(), data);
    result.emulator_error_sd = emulator->error_sd;
  }
  const MonthlyModel* const sampled_model =
      emulator ? static_cast<const MonthlyModel*>(&emulator->model) : &prototype;
  const auto posterior =
      TRY(Posterior::make(*sampled_model, problem.parameters, std::move(data), result.hyper_prior));
  auto sampled = TRY(sample_posterior(posterior, problem.inputs.names, options.sampling, context));
  result.chains = std::move(sampled.chains);
  result.parameters = std::move(sampled.parameters);
  result.hyperparameters = std::move(sampled.hyperparameters);
  result.sampling = std::move(sampled.report);
  result.converged = sampled.converged;
  result.posterior_mean.resize(static_cast<Eigen::Index>(result.parameters.size()));
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    result.posterior_mean(static_cast<Eigen::Index>(j)) = result.parameters[j].mean;
  }
  result.thinned = thin(result.chains, options.thinned_draws);
  add_posterior_findings(problem, result);
  append(result.findings, sampled.findings);
  TRY(check_model(posterior, sampled.points, problem, context, result));
  if (options.predictive) {
    result.predictions = TRY(predict_points(posterior, result.chains, context));
  }
  return result;
}

Result<Calibration> calibrate(const MonthlyModel& prototype, const CalibrationProblem& problem,
                              const CalibrationOptions& options, const RunContext& context) {
  // Check before the design too, so that an hour of model runs does not end in "weight
  // outside (0, 1]".
  TRY(check_problem(problem, prototype));
  TRY(check_calibration_options(options));
  auto design = TRY(run_design(prototype, problem, options.design_runs, context));
  return calibrate_on_design(prototype, problem, options, std::move(design), context);
}

}  // namespace recald::calibration
