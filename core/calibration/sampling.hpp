/// Turns a posterior into draws on which several chains agree, or reports that they do not.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/absent.hpp"
#include "core/calibration/posterior/draws.hpp"
#include "core/calibration/posterior/findings.hpp"
#include "core/calibration/posterior/posterior.hpp"
#include "core/calibration/posterior/summary.hpp"
#include "core/calibration/samplers/samplers.hpp"
#include "core/executor.hpp"
#include "core/result.hpp"

namespace recald::calibration {

/// The current stage. May come from any thread of the executor, so the observer
/// must be thread-safe.
struct Progress {
  enum class Stage { design, sampling, predicting };
  Stage stage;
  int chain;  ///< 0 during the design.
  int done;   ///< Design runs, or iterations of this chain, or its draws predicted with.
  int total;
};

/// Returns false to cancel.
using Observer = std::function<bool(const Progress&)>;

/// The caller's part: random numbers, threads, progress and cancelling.
struct RunContext {
  std::uint64_t seed = 1;
  ForEachIndex executor = for_each_index_serially;
  Observer observer = {};  ///< May be empty.
};

struct SamplingOptions {
  /// Null chooses automatically: NUTS if the model has a gradient, otherwise DRAM, started from a
  /// short tempered pilot that also checks them, and populations (SMC) instead if the chains
  /// disagree. A sampler given here is used alone and starts from the prior.
  const Sampler* sampler = nullptr;
  /// Of a chain, burn-in included. A given number is used exactly: nothing is doubled or replaced
  /// then, and a failed gate is reported.
  std::optional<int> iterations = {};
  std::optional<int> burn_in = {};
  int chains = 4;         ///< >= 2, otherwise R-hat says little. Chain k draws from stream k.
  int doublings_max = 2;  ///< How often the draws are doubled while the gate fails.
  ConvergenceGate gate;
};

/// How the draws were obtained.
struct SamplingReport {
  std::string sampler;  ///< The sampler that gave the draws.
  int burn_in = 0;      ///< Of each chain; 0 for populations.
  int kept = 0;         ///< Draws of each chain.
  int doublings = 0;
  std::string taken_over;  ///< Why populations replaced the chains; else empty.
  std::vector<ChainStatistics> chains;
  /// Everything that was run, including pilots and discarded chains.
  long density_evaluations = 0;
  long gradient_evaluations = 0;
  /// Natural log of p(y), mean over populations, and its standard error; NaN unless populations
  /// gave the draws (a pilot's are too few and too quick to estimate it).
  double log_evidence = kAbsent;
  double log_evidence_se = kAbsent;
};

struct SampledPosterior {
  std::vector<ChainDraws> chains;
  std::vector<Summary> parameters;       ///< (q)
  std::vector<Summary> hyperparameters;  ///< lambda_delta, lambda_eps, beta_<input> …, beta_out
  SamplingReport report;
  /// (at most 2000 x d) equally spaced draws in the posterior's coordinates, chains one below the
  /// other, for bridge sampling of the evidence.
  Eigen::MatrixXd points;
  Findings findings;  ///< From the gate (none: converged), jitter, or a change of sampler.
  bool converged = false;
};

/// Samples until the gate holds for every parameter and hyper-parameter, doubling the draws at most
/// `doublings_max` times.
///
/// @param input_names  Of the model inputs, for the names of hyper-parameters.
/// @return the draws, converged or not; invalid_value for invalid options; an error of the
///         model; cancelled.
/// @note   Pure: the same posterior, options and seed give the same bytes with any executor.
[[nodiscard]] Result<SampledPosterior> sample_posterior(const Posterior& posterior,
                                                        const std::vector<std::string>& input_names,
                                                        const SamplingOptions& options,
                                                        const RunContext& context);

/// @return invalid_value unless `sample_posterior` would accept the options.
[[nodiscard]] Result<void> check_sampling(const SamplingOptions& options);

}  // namespace recald::calibration
