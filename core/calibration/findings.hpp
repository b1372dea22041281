/// What a calibration wants a person to know besides its numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace recald::calibration {

enum class FindingKind {
  extrapolation,        ///< A measured value outside all design runs of all months.
  range_fail,           ///< A measured value outside the design runs of its own month.
  prior_edge,           ///< Posterior mass piled up at the end of a prior: a model-form alarm.
  hyperprior_conflict,  ///< A precision's posterior mean outside its prior's 1-99 % range.
  not_converged,        ///< The convergence gate failed for a quantity.
  prior_driven,         ///< A parameter follows the discrepancy prior rather than the data.
  sampler_replaced,     ///< Chains could not agree and populations took their place.
  weak_direction,       ///< A combination of parameters that the data leave as the prior had it.
  evidence_disagrees,   ///< Two ways to the evidence differ by more than half a nat.
  discrepancy_size,     ///< What the model misses, and so what cannot be read from it.
  jitter_used,          ///< Some covariance had no factor until jitter was added.
};

/// The kind as files and machines write it: "range_fail".
[[nodiscard]] std::string_view to_string(FindingKind kind);

struct Finding {
  FindingKind kind;
  std::string subject;       ///< The parameter, hyper-parameter or output it is about.
  std::string sentence;      ///< Plain words, as short as a line of a terminal.
  std::string details = {};  ///< Further sentences with the figures; empty: none.
  /// Of the months, or of the energy, that it is about; 0 where it is about neither.
  double share = 0.0;
};

using Findings = std::vector<Finding>;

}  // namespace recald::calibration
