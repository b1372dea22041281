/// A model's stand-in for the many evaluations that sampling and following a site take.
#pragma once

#include <Eigen/Core>

#include "core/calibration/posterior.hpp"
#include "core/model/metamodel/quadratic_model.hpp"
#include "core/result.hpp"

namespace recald::calibration {

struct Emulator {
  model::metamodel::QuadraticModel model;
  /// (outputs * months) sd of what is left, in units: of runs that each fit has not seen. To be
  /// counted among what a point's variance is known to contain.
  Eigen::VectorXd error_sd;
};

/// A polynomial of second degree in the parameters for each output and month, fitted to runs of the
/// model: a monthly figure is smooth in what it is calibrated with.
/// @param theta    (runs x q) in units, spread over the priors.
/// @param outputs  (runs x output_count * month_count) in units, output-major.
/// @return or not_enough_data where there are fewer than twice as many runs as coefficients.
[[nodiscard]] Result<Emulator> emulate(const Eigen::MatrixXd& theta, const Eigen::MatrixXd& outputs,
                                       int output_count, int month_count);

/// Adds the emulator's variance to what is known of each point.
/// @param error_sd  (outputs * months) in units, output-major.
void add_emulator_error(const Eigen::VectorXd& error_sd, int month_count, PosteriorData& data);

}  // namespace recald::calibration
