/// What a regression's months may be off by, learnt from months that were left out.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/change_point/regression.hpp"
#include "core/change_point/selection.hpp"

namespace recald::change_point {

/// The training days as the fit sees them, (n) each.
struct FittedDays {
  Eigen::VectorXd level_kWh;     ///< Expected.
  Eigen::VectorXd residual_kWh;  ///< Measured minus expected.
  Eigen::VectorXd sd_kWh;        ///< By `Regression::scatter`.
};

/// Sets the day's correlation, the variance of months, the covariance of the parameters and the
/// widening of a regression whose curves and scatter are known.
/// @param left_out_residual_kWh  (n) of the chosen form, by cross-validation.
/// @see   fit_regression, for the noise assumed.
void learn_errors(std::span<const TrainingDay> days, std::span<const double> left_out_residual_kWh,
                  const FittedDays& fitted, Regression& regression);

}  // namespace recald::change_point
