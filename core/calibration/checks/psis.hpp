/// How well a calibrated model predicts a left-out unit of data, without refitting.
#pragma once

#include <Eigen/Core>

#include "core/result.hpp"

namespace recald::calibration {

/// Importance weights whose largest have been replaced by quantiles of a fitted tail.
struct SmoothedWeights {
  Eigen::VectorXd log_weight;  ///< (draws) normalised: the weights sum to one.
  /// Shape of the tail. Above 0.7 the estimate is unreliable; infinite when there are too few
  /// draws to fit one.
  double pareto_k;
};

/// Pareto-smoothed importance sampling of the ratios exp(log_ratio).
///
/// The largest min(0.2 S, 3 sqrt(S / r)) of S ratios are replaced by the expected order statistics
/// of a generalised Pareto density fitted to them (Zhang, Stephens 2009, with the weak prior of
/// `loo`), and truncated at the largest ratio.
///
/// @param log_ratio            (S) up to a constant.
/// @param relative_efficiency  r: effective over actual draws, 1 for independent ones.
/// @pre log_ratio is finite, S >= 1, r > 0
/// @see Vehtari, Simpson, Gelman, Yao, Gabry (2024), J. Mach. Learn. Res. 25; same numbers as R's
///      loo.
[[nodiscard]] SmoothedWeights pareto_smooth(const Eigen::VectorXd& log_ratio,
                                            double relative_efficiency = 1.0);

/// Leave-one-out estimates, one per unit: a month, or whatever the caller leaves out at a time.
struct LeaveOneOut {
  double elpd;            ///< Sum over units of the log predictive density of the left-out unit.
  double standard_error;  ///< Of `elpd`, from its spread over units: sqrt(units * variance).
  double effective_parameters;  ///< Log density with the units minus `elpd`: p_loo.
  Eigen::VectorXd unit_elpd;    ///< (units)
  Eigen::VectorXd pareto_k;     ///< (units) above 0.7: refit without the unit.
};

/// PSIS-LOO from the log likelihood of each unit under each draw, given the draw's parameters (and,
/// for units that are correlated given the parameters, given the other units).
///
/// @param log_likelihood       (draws x units)
/// @param relative_efficiency  Of the draws, as in `pareto_smooth`.
/// @return the estimates; not_enough_data for no unit or fewer than 5 draws; not_finite for a NaN
///         or infinity in `log_likelihood`, with its position.
/// @see   Vehtari, Gelman, Gabry (2017), Stat. Comput. 27.
[[nodiscard]] Result<LeaveOneOut> psis_loo(const Eigen::MatrixXd& log_likelihood,
                                           double relative_efficiency = 1.0);

}  // namespace recald::calibration
