/// Whether a result comes from the data or from the discrepancy prior.
#pragma once

#include <vector>

#include "core/calibration/calibration.hpp"

namespace recald::calibration {

/// How far a parameter's posterior mean moves when the discrepancy is assumed smaller or larger.
struct ParameterSensitivity {
  double mean_at_smaller;  ///< lambda_delta's prior mean times `factor`, parameter's unit.
  double mean_at_larger;   ///< lambda_delta's prior mean over `factor`, parameter's unit.
  double largest_move_sd;  ///< Larger of the two moves, in posterior sd of the base calibration.
  bool prior_driven;       ///< largest_move_sd > 0.5
};

struct PriorSensitivity {
  double factor;
  std::vector<ParameterSensitivity> parameters;  ///< (q)
  Findings findings;  ///< One per prior-driven parameter, and those of failed gates.
};

/// Calibrates twice more on the design of `base`, with the prior mean of lambda_delta multiplied
/// and divided by `factor` (shape kept). Costs two calibrations.
/// @pre factor > 1, `base` belongs to this problem
[[nodiscard]] Result<PriorSensitivity> prior_sensitivity(const MonthlyModel& prototype,
                                                         const CalibrationProblem& problem,
                                                         const CalibrationOptions& options,
                                                         const Calibration& base,
                                                         const RunContext& context,
                                                         double factor = 4.0);

}  // namespace recald::calibration
