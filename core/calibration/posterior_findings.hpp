/// Signs in a posterior that the model or the priors are wrong.
#pragma once

#include <optional>
#include <vector>

#include "core/calibration/checks/bridge.hpp"
#include "core/calibration/covariance/hyper_prior.hpp"
#include "core/calibration/posterior/draws.hpp"
#include "core/calibration/posterior/findings.hpp"
#include "core/calibration/posterior/normalisation.hpp"
#include "core/calibration/posterior/summary.hpp"
#include "core/calibration/sampling.hpp"
#include "core/model/parameter.hpp"

namespace recald::calibration {

/// `prior_edge`: more than 20 % of the mass lies within 5 % of the prior's range from one
/// of its bounds. Unless the bound is a physical limit, this is a sign of a wrong model
/// form, not a result.
[[nodiscard]] Findings edge_findings(const std::vector<Parameter>& parameters,
                                     const std::vector<ChainDraws>& chains);

/// `hyperprior_conflict`: the posterior mean of a precision outside its prior's 1-99 % range.
[[nodiscard]] Findings conflict_findings(const Summary& precision, const GammaPrior& prior);

/// `not_converged`: trajectories that diverged, or an energy that a chain explores too slowly. Then
/// part of the posterior may never have been visited, whatever R-hat says.
[[nodiscard]] Findings trajectory_findings(const std::vector<ChainStatistics>& chains,
                                           const ConvergenceGate& gate);

/// `evidence_disagrees`: the estimates by bridge and populations, if both exist, differ
/// by more than 0.5.
[[nodiscard]] Findings evidence_findings(const SamplingReport& report,
                                         const std::optional<BridgeEstimate>& bridge);

/// `discrepancy_size`: the sd of the discrepancy of each measured output as a share of the measured
/// mean; the sentence names the largest. Nothing smaller can be read from the model, and the
/// discrepancy belongs to the months that were measured: it is never carried elsewhere.
[[nodiscard]] Findings discrepancy_findings(const std::vector<OutputMeasurements>& outputs,
                                            const Normalisation& normalisation,
                                            const std::vector<ChainDraws>& chains);

/// `jitter_used`: `count` covariances could not be factorised without jitter.
[[nodiscard]] Findings jitter_findings(long count);

}  // namespace recald::calibration
