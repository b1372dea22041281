/// What people should know about a calibration besides its numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace recald::calibration {

enum class FindingKind {
  extrapolation,        ///< A measured value outside all design runs of all months.
  range_fail,           ///< A measured value outside the design runs of its own month.
  prior_edge,           ///< Posterior mass near a bound of a prior: the model form may be wrong.
  hyperprior_conflict,  ///< A precision's posterior mean outside its prior's 1-99 % range.
  not_converged,        ///< The convergence gate failed for a quantity.
  prior_driven,         ///< A parameter follows the discrepancy prior rather than the data.
  sampler_replaced,     ///< The chains disagreed and populations replaced them.
  weak_direction,       ///< A combination of parameters that the data did not inform.
  evidence_disagrees,   ///< Two estimates of the evidence differ by more than half a nat.
  discrepancy_size,     ///< The size of the model discrepancy, which limits what can be concluded.
  jitter_used,          ///< Some covariance could not be factorised without jitter.
};

/// The kind as written in files: "range_fail".
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

inline void append(Findings& all, const Findings& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace recald::calibration
