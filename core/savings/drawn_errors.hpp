/// What a calibrated model is off by in all months, drawn as the measured months leave it.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/assessment/model_errors.hpp"
#include "core/calibration/calibration.hpp"
#include "core/random/rng.hpp"
#include "core/result.hpp"

namespace recald::savings {

/// A model answers to a measure with the parameters that fit the building, not with those that the
/// building has, and its meters are off by factors. Both are errors common to all months
/// (assessment/model_errors.hpp); the discrepancy is the same with a measure and without, and
/// cancels.
struct DrawnErrors {
  /// (draws x q) theta plus what each parameter means in the model, inside its limits.
  Eigen::MatrixXd theta;
  /// (draws x outputs) Factors > 0 on what the model has, and so on what a measure saves.
  Eigen::MatrixXd level;
};

/// Values that a parameter may take in a model.
struct Limits {
  double least;
  double most;
};

/// Given a draw (theta, phi) the coefficients z of the common errors G are normal a priori, and
/// with r = y - f(theta) and Sigma = C + G G' + N
///
///     z | y ~ N( G' Sigma^-1 r,  I - G' Sigma^-1 G ).
///
/// @param problem    As calibrated.
/// @param errors     (common errors of `problem`) what each is of.
/// @param draws      Of `calibration`, q parameters.
/// @param simulated  (draws x outputs * months) f there, in units.
/// @param limits     (q)
/// @return not_positive_definite when a draw's covariance has no factor; not_finite when the model
///         gives a value that is not.
/// @see Rasmussen, Williams (2006), Gaussian Processes for Machine Learning, section 2.7.
[[nodiscard]] Result<DrawnErrors> draw_errors(const calibration::CalibrationProblem& problem,
                                              std::span<const assessment::CommonError> errors,
                                              const calibration::Calibration& calibration,
                                              const calibration::ThinnedDraws& draws,
                                              const Eigen::MatrixXd& simulated,
                                              std::span<const Limits> limits, Rng& rng);

/// Relative sd of what a model answers to a change, over what the building does. Months without
/// the change do not test it.
struct ResponseErrors {
  double electricity;
  double cooling;
  double heating;

  [[nodiscard]] double of(assessment::Service service) const;
};

/// Of built-in models as found where the truth is known (tests/results/savings.md), of EnergyPlus
/// models assumed.
[[nodiscard]] const ResponseErrors& response_errors(ModelKind kind);

/// (draws x outputs) Factors of median 1 on what a measure saves, log-normal.
/// @param services  (outputs)
[[nodiscard]] Eigen::MatrixXd draw_responses(Eigen::Index draws,
                                             std::span<const assessment::Service> services,
                                             const ResponseErrors& sizes, Rng& rng);

/// One sd of what a measure does to a meter that a model does not have, as a share of its use.
inline constexpr double kMissedShare = 0.005;

/// (draws x outputs) That share, normal with mean 0.
[[nodiscard]] Eigen::MatrixXd draw_missed(Eigen::Index draws, Eigen::Index outputs, Rng& rng);

}  // namespace recald::savings
