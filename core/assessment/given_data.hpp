/// What meters are expected to show, given the months that were measured.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/assessment/assessed_calibration.hpp"
#include "core/assessment/forecast.hpp"
#include "core/result.hpp"

namespace recald::assessment {

/// Forecasts of one output, in its unit. Absent where nothing can be said.
struct OutputForecasts {
  /// (months) Unseen ones given all calibration months; each calibration month given the others.
  std::vector<std::optional<Forecast>> months;
  /// (months) Calibration months given those outside their block of three, in order of time.
  std::vector<std::optional<Forecast>> blocks;
  /// Of the mean over the validation months that are measured, longer months counting for more.
  std::optional<Forecast> unseen_mean;
  /// Calibration months whose importance weights say little (Pareto k above 0.7).
  int unreliable_months = 0;
};

/// Gives every output that is followed by the model's errors the scale of its design runs: it had
/// no share in the normalisation. One that no run moves is followed by its level.
void scale_followed(AssessedCalibration& result);

/// A fitted output is the model and what the measured points say of its discrepancy and common
/// errors: given a draw (theta, phi), with S = C(phi) + G G' and N the independent errors,
///
///     y_* | y_t ~ N( f_* + S_*t (S_tt + N)^-1 (y - f)_t,  S_** - S_*t (S_tt + N)^-1 S_t* + N )
///
/// for all months together, and a mixture of these over the draws. A month is left out by
/// importance weights (PSIS). An output that is not fitted is followed as it says.
///
/// @param simulated  (draws x outputs * months) f at `result.calibration.thinned`, in units.
/// @return one a modelled output; not_positive_definite when a draw's covariance has no factor;
///         not_finite when the model gives a value that is not.
/// @see Rasmussen, Williams (2006), Gaussian Processes for Machine Learning, eqs. (2.22)-(2.24).
[[nodiscard]] Result<std::vector<OutputForecasts>> forecast_given_data(
    const AssessedCalibration& result, const WholePeriod& whole, const Eigen::MatrixXd& simulated);

/// The errors of an output's months are not all alike. What the calibration months, each forecast
/// from the others, show of their scatter widens or narrows every forecast of the output, as months
/// that come in one by one do where a site is followed (spread.hpp). The mean of unseen months
/// stays as it is. An output that is not fitted is left alone.
/// @param k  Which output.
void adapt_to_scatter(const AssessedCalibration& result, std::size_t k, OutputForecasts& forecasts);

}  // namespace recald::assessment
