/// Running a building model at many parameter values: a design, or posterior draws.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>

#include "core/executor.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"

namespace recald::design {

/// Told after each run how many are done; returns false to stop. With a parallel executor it is
/// called from the executor's threads, so it has to be safe for that.
using RunObserver = std::function<bool(int done, int total)>;

/// Evaluates the model at every row of `theta`.
///
/// @param prototype   Cloned, never evaluated itself.
/// @param parameters  (q) only to name the values in an error.
/// @param theta       (runs x q) in the parameters' own units.
/// @param observer    Empty: cannot be stopped.
/// @param executor    Runs blocks of rows side by side; the result does not depend on it.
/// @return (runs x output_count * month_count), each row output-major as `MonthlyModel` writes it;
/// or
///         not_finite  an output is NaN or infinite (says which output, month and parameter
///         values); cancelled   the observer said stop.
[[nodiscard]] Result<Eigen::MatrixXd> run_model(const MonthlyModel& prototype,
                                                std::span<const Parameter> parameters,
                                                const Eigen::MatrixXd& theta,
                                                const ForEachIndex& executor,
                                                const RunObserver& observer);

/// The error both this and the posterior give for a NaN or infinity in `outputs`, or success.
[[nodiscard]] Result<void> check_finite(std::span<const Parameter> parameters,
                                        std::span<const double> theta,
                                        std::span<const double> outputs, int month_count);

}  // namespace recald::design
