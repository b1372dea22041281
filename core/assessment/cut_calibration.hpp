/// A calibration of parameters θ given draws of others, η, which the months must not teach again.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/assessment/assessed_calibration.hpp"
#include "core/calibration/calibration.hpp"
#include "core/model/monthly_model.hpp"
#include "core/result.hpp"

namespace recald::assessment {

/// Some draws of η, equally spaced. @param draws  (draws x r)
[[nodiscard]] Eigen::MatrixXd spread_eta(const Eigen::MatrixXd& draws);

/// η as some months alone move it, from θ and η together.
/// @param r        Parameters that are η, the last ones of the problem.
/// @param teaches  (months) whether each may teach η.
/// @return draws of η; or what a calibration on so few months finds.
[[nodiscard]] Result<Eigen::MatrixXd> taught_by_months(
    const MonthlyModel& model, const calibration::CalibrationProblem& problem, Eigen::Index r,
    const std::vector<bool>& teaches, const calibration::CalibrationOptions& options,
    const calibration::RunContext& context);

/// Calibrates θ at the mean of η, then given each draw of η, and pools the draws of θ and η into
/// `result.calibration`.
/// @param model    θ (q), then η (r).
/// @param problem  Of θ and η.
/// @param design   Runs over the priors of θ and η. With `options.emulate` the draws at each η, and
///                 the predictions, are of a polynomial fitted to them where they suffice.
/// @param eta      (n x r)
[[nodiscard]] Result<void> calibrate_given_eta(
    const MonthlyModel& model, const calibration::CalibrationProblem& problem,
    const calibration::DesignRuns& design, const Eigen::MatrixXd& eta,
    const calibration::CalibrationOptions& options, bool prior_sensitivity,
    const calibration::RunContext& context, AssessedCalibration& result);

}  // namespace recald::assessment
