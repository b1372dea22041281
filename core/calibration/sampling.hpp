/// From a posterior to draws that several chains agree on, or to the plain statement that they do
/// not.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/absent.hpp"
#include "core/calibration/draws.hpp"
#include "core/calibration/findings.hpp"
#include "core/calibration/posterior.hpp"
#include "core/calibration/samplers.hpp"
#include "core/calibration/summary.hpp"
#include "core/executor.hpp"
#include "core/result.hpp"

namespace recald::calibration {

/// What is being done. Comes from any thread the executor uses, so the observer has to be safe for
/// that.
struct Progress {
  enum class Stage { design, sampling, predicting };
  Stage stage;
  int chain;  ///< 0 during the design.
  int done;   ///< Design runs, or iterations of this chain, or its draws predicted with.
  int total;
};

/// Returns false to cancel.
using Observer = std::function<bool(const Progress&)>;

/// How a caller takes part: chance, threads, and the wish to stop.
struct RunContext {
  std::uint64_t seed = 1;
  ForEachIndex executor = for_each_index_serially;
  Observer observer = {};  ///< May be empty.
};

struct SamplingOptions {
  /// Null chooses: NUTS where the model has a gradient, DRAM where it has none, from a short
  /// tempered pilot that also checks them, and populations (SMC) in their place when the chains
  /// cannot agree. A sampler named here is used alone and starts from the prior.
  const Sampler* sampler = nullptr;
  /// Of a chain, burn-in included. Whoever gives a number gets it: nothing is doubled or replaced
  /// then, and a gate that fails is reported.
  std::optional<int> iterations = {};
  std::optional<int> burn_in = {};
  int chains = 4;         ///< >= 2, or R-hat says little. Chain k draws from stream k.
  int doublings_max = 2;  ///< How often the draws are doubled while the gate fails.
  ConvergenceGate gate;
};

/// What it took.
struct SamplingReport {
  std::string sampler;  ///< That gave the draws.
  int burn_in = 0;      ///< Of each chain; 0 for populations.
  int kept = 0;         ///< Draws of each chain.
  int doublings = 0;
  std::string taken_over;  ///< Why populations took the place of chains; else empty.
  std::vector<ChainStatistics> chains;
  /// Everything that was run, pilots and discarded chains included.
  long density_evaluations = 0;
  long gradient_evaluations = 0;
  /// Natural log of p(y), mean over populations, and its standard error; NaN unless populations
  /// gave the draws (those of a pilot are too few and too quick to know it).
  double log_evidence = kAbsent;
  double log_evidence_se = kAbsent;
};

struct SampledPosterior {
  std::vector<ChainDraws> chains;
  std::vector<Summary> parameters;       ///< (q)
  std::vector<Summary> hyperparameters;  ///< lambda_delta, lambda_eps, beta_<input> …, beta_out
  SamplingReport report;
  /// (at most 2000 x d) equally spaced draws in the posterior's coordinates, chains one below the
  /// other: what a bridge to the evidence needs.
  Eigen::MatrixXd points;
  Findings findings;  ///< Of the gate (none: converged), of jitter, of a change of sampler.
  bool converged = false;
};

/// Samples until the gate holds for every parameter and hyper-parameter, doubling the draws at most
/// `doublings_max` times.
///
/// @param input_names  Of the model inputs, for the names of hyper-parameters.
/// @return the draws, converged or not; invalid_value for options that make no sense; an error of
///         the model; cancelled.
/// @note   Pure: the same posterior, options and seed give the same bytes with any executor.
[[nodiscard]] Result<SampledPosterior> sample_posterior(const Posterior& posterior,
                                                        const std::vector<std::string>& input_names,
                                                        const SamplingOptions& options,
                                                        const RunContext& context);

/// @return invalid_value unless `sample_posterior` would accept the options.
[[nodiscard]] Result<void> check_sampling(const SamplingOptions& options);

}  // namespace recald::calibration
