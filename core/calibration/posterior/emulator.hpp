/// Replaces a model in the many evaluations of sampling and monitoring.
#pragma once

#include <Eigen/Core>

#include "core/calibration/posterior/posterior.hpp"
#include "core/model/metamodel/quadratic_model.hpp"
#include "core/result.hpp"

namespace recald::calibration {

struct Emulator {
  model::metamodel::QuadraticModel model;
  /// (outputs * months) sd of the remaining error, in units, for runs left out of the fit. It must
  /// be included in the known variance of each point.
  Eigen::VectorXd error_sd;
};

/// A quadratic polynomial in the parameters for each output and month, fitted to runs of the model.
/// It works because a monthly figure is smooth in the calibration parameters.
/// @param theta    (runs x q) in units, spread over the priors.
/// @param outputs  (runs x output_count * month_count) in units, output-major.
/// @return the emulator, or not_enough_data for fewer than twice as many runs as coefficients.
[[nodiscard]] Result<Emulator> emulate(const Eigen::MatrixXd& theta, const Eigen::MatrixXd& outputs,
                                       int output_count, int month_count);

/// Adds the emulator's variance to the known variance of each point.
/// @param error_sd  (outputs * months) in units, output-major.
void add_emulator_error(const Eigen::VectorXd& error_sd, int month_count, PosteriorData& data);

}  // namespace recald::calibration
