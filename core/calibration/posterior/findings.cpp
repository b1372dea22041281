#include "core/calibration/posterior/findings.hpp"

#include <cassert>

namespace recald::calibration {

std::string_view to_string(FindingKind kind) {
  switch (kind) {
    case FindingKind::extrapolation:
      return "extrapolation";
    case FindingKind::range_fail:
      return "range_fail";
    case FindingKind::prior_edge:
      return "prior_edge";
    case FindingKind::hyperprior_conflict:
      return "hyperprior_conflict";
    case FindingKind::not_converged:
      return "not_converged";
    case FindingKind::prior_driven:
      return "prior_driven";
    case FindingKind::sampler_replaced:
      return "sampler_replaced";
    case FindingKind::weak_direction:
      return "weak_direction";
    case FindingKind::evidence_disagrees:
      return "evidence_disagrees";
    case FindingKind::discrepancy_size:
      return "discrepancy_size";
    case FindingKind::jitter_used:
      return "jitter_used";
  }
  assert(false);
  return "";
}

}  // namespace recald::calibration
