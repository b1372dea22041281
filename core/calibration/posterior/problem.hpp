/// The input of a calibration, checked and normalised.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/calibration/posterior/normalisation.hpp"
#include "core/calibration/posterior/posterior.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"

namespace recald::calibration {

/// Known inputs over which the discrepancy varies, such as monthly mean dry bulb, in
/// their own units.
struct ModelInputs {
  std::vector<std::string> names;  ///< (p)
  Eigen::MatrixXd values;          ///< (months x p)
};

/// Covers exactly the calibration months of its model.
struct CalibrationProblem {
  std::vector<Parameter> parameters;        ///< (q) in the model's order.
  std::vector<std::string> month_names;     ///< (months) for sentences: "2016-03".
  std::vector<OutputMeasurements> outputs;  ///< (output_count) in the model's order.
  ModelInputs inputs;
  /// Directions of error common to all points, 1 standard deviation each, in output units, e.g.
  /// df/dshare * 0.15 for the share of a profile that heats the zone. Each (output_count * months),
  /// output-major.
  std::vector<Eigen::VectorXd> common_errors;
  /// (output_count * month_count) sd of a meta-model's own error in output units, output-major;
  /// empty: the model is exact.
  Eigen::VectorXd model_error_sd;
};

/// θ and the two variances: with fewer points than unknowns the result would be just the prior.
constexpr int kPointsBeyondParameters = 2;

[[nodiscard]] int measured_points(const CalibrationProblem& problem);

/// Checks everything that data and configuration can get wrong, before anything is computed.
///
/// @return not_enough_data  fewer measured points than calibration parameters plus two;
///         invalid_value    a weight outside (0, 1], a negative or missing extra variance, a prior
///                          out of order, names or shapes that do not fit the
///                          model, no model input,
///                          or one that is the same in every month;
///         not_finite       an infinite measurement, or a NaN among the model inputs.
[[nodiscard]] Result<void> check_problem(const CalibrationProblem& problem,
                                         const MonthlyModel& model);

/// The measured points on the normalised scale. Weights are relative: they are divided by the
/// largest among the measured outputs.
/// @param reference_months  Inputs are scaled by their range over the first so many
///                          months; 0: all of them.
/// @pre check_problem passed
[[nodiscard]] PosteriorData normalise_problem(const CalibrationProblem& problem,
                                              const Normalisation& normalisation,
                                              Eigen::Index reference_months = 0);

/// Scales each column by its min and max over the first `reference_months`. Later months must not
/// change results for earlier ones, so they may leave [0, 1]. @pre no column is constant over them
[[nodiscard]] Eigen::MatrixXd scale_inputs(const Eigen::MatrixXd& values,
                                           Eigen::Index reference_months);

}  // namespace recald::calibration
