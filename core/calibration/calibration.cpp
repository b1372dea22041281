#include "core/calibration/calibration.hpp"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "core/calibration/posterior.hpp"
#include "core/calibration/posterior_findings.hpp"
#include "core/design/latin_hypercube.hpp"
#include "core/design/model_runs.hpp"

namespace recald::calibration {
namespace {

constexpr int kDesignRunsMin = 20;
/// Chains draw from streams 0, 1, …; the design's stream lies beyond any number of chains.
constexpr std::uint64_t kDesignStream = std::uint64_t{1} << 32;

Result<void> check_calibration_options(const CalibrationOptions& options) {
  if (options.chains < 2) {
    return failure(ErrorCode::invalid_value,
                   "a calibration needs at least 2 chains to tell whether they agree, but " +
                       std::to_string(options.chains) + " is asked for");
  }
  if (options.thinned_draws < 1) {
    return failure(ErrorCode::invalid_value, "at least 1 thinned draw has to be asked for");
  }
  if (auto ok = check_options(options.sampling); !ok) return ok;
  if (options.sampling.iterations - options.sampling.burn_in < 8) {
    return failure(ErrorCode::invalid_value,
                   "at least 8 iterations have to remain after burn-in to judge convergence");
  }
  return {};
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

struct SampledChain {
  ChainDraws draws;
  long jitter_count;
};

Result<SampledChain> run_chain(const Posterior& prototype, int k, const CalibrationOptions& options,
                               const RunContext& context) {
  Posterior posterior(prototype);
  Rng rng(context.seed, static_cast<std::uint64_t>(k));
  const SamplerObserver observer = [&context, k](int done, int total) {
    return !context.observer || context.observer({Progress::Stage::sampling, k, done, total});
  };
  const auto chain = options.sampler(posterior, options.sampling, rng, observer);
  if (!chain) return tl::unexpected(chain.error());
  return SampledChain{to_natural_units(*chain, posterior), posterior.jitter_count()};
}

Result<std::vector<SampledChain>> run_chains(const Posterior& prototype,
                                             const CalibrationOptions& options,
                                             const RunContext& context) {
  std::vector<std::optional<Result<SampledChain>>> slots(static_cast<std::size_t>(options.chains));
  context.executor(slots.size(), [&](std::size_t k) {
    slots[k] = run_chain(prototype, static_cast<int>(k), options, context);
  });
  std::vector<SampledChain> chains;
  for (auto& slot : slots) {
    if (!*slot) return tl::unexpected(slot->error());
    chains.push_back(std::move(**slot));
  }
  return chains;
}

void append(Findings& all, Findings more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

void add_posterior_findings(const CalibrationProblem& problem, const ConvergenceGate& gate,
                            Calibration& c) {
  append(c.findings, edge_findings(problem.parameters, c.chains));
  append(c.findings, conflict_findings(c.hyperparameters[0], c.hyper_prior.discrepancy_precision));
  append(c.findings, conflict_findings(c.hyperparameters[1], c.hyper_prior.error_precision));
  Findings unconverged = gate_findings(c.parameters, gate);
  append(unconverged, gate_findings(c.hyperparameters, gate));
  c.converged = unconverged.empty();
  append(c.findings, std::move(unconverged));
}

}  // namespace

Result<DesignRuns> run_design(const MonthlyModel& prototype, const CalibrationProblem& problem,
                              int runs, const RunContext& context) {
  if (runs < kDesignRunsMin) {
    return failure(ErrorCode::invalid_value, "a design needs at least " +
                                                 std::to_string(kDesignRunsMin) + " runs, but " +
                                                 std::to_string(runs) + " are asked for");
  }
  Rng rng(context.seed, kDesignStream);
  DesignRuns design;
  design.theta = design::latin_hypercube(problem.parameters, runs, rng);
  const design::RunObserver observer = [&context](int done, int total) {
    return !context.observer || context.observer({Progress::Stage::design, 0, done, total});
  };
  auto outputs =
      design::run_model(prototype, problem.parameters, design.theta, context.executor, observer);
  if (!outputs) return tl::unexpected(std::move(outputs.error()));
  design.outputs = std::move(*outputs);
  return design;
}

Result<Calibration> calibrate_on_design(const MonthlyModel& prototype,
                                        const CalibrationProblem& problem,
                                        const CalibrationOptions& options, DesignRuns design,
                                        const RunContext& context) {
  if (auto ok = check_problem(problem, prototype); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_calibration_options(options); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_design(design, problem); !ok) return tl::unexpected(ok.error());
  auto normalisation = normalise_design(design.outputs, problem.outputs, prototype.month_count());
  if (!normalisation) return tl::unexpected(normalisation.error());

  Calibration result{};
  result.seed = context.seed;
  result.design = std::move(design);
  result.normalisation = std::move(*normalisation);
  result.range = check_range(result.design.outputs, problem.outputs, result.normalisation);
  result.findings = range_findings(result.range, problem.outputs, problem.month_names);
  result.hyper_prior = chosen_hyper_prior(options, result.normalisation.pooled_variance);

  const auto posterior =
      Posterior::make(prototype, problem.parameters,
                      normalise_problem(problem, result.normalisation), result.hyper_prior);
  if (!posterior) return tl::unexpected(posterior.error());
  auto chains = run_chains(*posterior, options, context);
  if (!chains) return tl::unexpected(chains.error());
  long jitter_count = 0;
  for (SampledChain& chain : *chains) {
    jitter_count += chain.jitter_count;
    result.chains.push_back(std::move(chain.draws));
  }
  append(result.findings, jitter_findings(jitter_count));

  result.parameters = summarise_parameters(problem.parameters, result.chains, context.executor);
  const auto names = hyperparameter_names(problem.inputs.names, posterior->has_output_dimension());
  result.hyperparameters =
      summarise_hyperparameters(result.hyper_prior, names, result.chains, context.executor);
  result.posterior_mean.resize(static_cast<Eigen::Index>(result.parameters.size()));
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    result.posterior_mean(static_cast<Eigen::Index>(j)) = result.parameters[j].mean;
  }
  result.thinned = thin(result.chains, options.thinned_draws);
  add_posterior_findings(problem, options.gate, result);
  return result;
}

Result<Calibration> calibrate(const MonthlyModel& prototype, const CalibrationProblem& problem,
                              const CalibrationOptions& options, const RunContext& context) {
  // Before the design too: an hour of model runs should not end in "weight outside (0, 1]".
  if (auto ok = check_problem(problem, prototype); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_calibration_options(options); !ok) return tl::unexpected(ok.error());
  auto design = run_design(prototype, problem, options.design_runs, context);
  if (!design) return tl::unexpected(design.error());
  return calibrate_on_design(prototype, problem, options, std::move(*design), context);
}

}  // namespace recald::calibration
