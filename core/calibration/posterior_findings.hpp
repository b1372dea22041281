/// What a posterior says against the model or the beliefs that went into it.
#pragma once

#include <vector>

#include "core/calibration/draws.hpp"
#include "core/calibration/findings.hpp"
#include "core/calibration/hyper_prior.hpp"
#include "core/calibration/summary.hpp"
#include "core/model/parameter.hpp"

namespace recald::calibration {

/// `prior_edge`: more than 20 % of the mass within 5 % of the prior's range of one of its ends. A
/// posterior piled up there is a model-form alarm, not a result, unless the end is a physical
/// limit.
[[nodiscard]] Findings edge_findings(const std::vector<Parameter>& parameters,
                                     const std::vector<ChainDraws>& chains);

/// `hyperprior_conflict`: the posterior mean of a precision outside its prior's 1-99 % range.
[[nodiscard]] Findings conflict_findings(const Summary& precision, const GammaPrior& prior);

/// `jitter_used`: `count` covariances had no Cholesky factor as they were.
[[nodiscard]] Findings jitter_findings(long count);

}  // namespace recald::calibration
