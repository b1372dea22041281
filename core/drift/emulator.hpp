/// A model's stand-in for the many evaluations that following a site takes.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/executor.hpp"
#include "core/model/metamodel/quadratic_model.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"

namespace recald::drift {

struct Emulator {
  model::metamodel::QuadraticModel model;
  /// (outputs * months) sd of what is left, in units: of runs that each fit has not seen. To be
  /// counted among what a point's variance is known to contain.
  Eigen::VectorXd error_sd;
};

/// A polynomial of second degree in the parameters for each output and month, fitted to runs of the
/// model: a monthly figure is smooth in what it is calibrated with.
/// @param theta  (runs x q) in units, spread over the priors.
/// @return or an error of the model; not_enough_data where there are fewer than twice as many runs
///         as coefficients.
[[nodiscard]] Result<Emulator> emulate(const MonthlyModel& model,
                                       std::span<const Parameter> parameters,
                                       const Eigen::MatrixXd& theta, const ForEachIndex& executor);

}  // namespace recald::drift
