/// A followed site's months, ready for a sequence of posteriors.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/assessment/assessed_calibration.hpp"
#include "core/calibration/posterior/normalisation.hpp"
#include "core/calibration/posterior/posterior.hpp"
#include "core/calibration/posterior/problem.hpp"
#include "core/drift/prequential.hpp"
#include "core/model/monthly_model.hpp"

namespace recald::drift {

/// What is known of a site before it is followed. Months are all those followed, the learning ones
/// first.
struct FollowedSite {
  /// Months, parameters and outputs; those that no parameter moves are not calibrated.
  const assessment::AssessedCalibration& site;
  MonthlyModel& model;
  int learning_months;
  calibration::ModelInputs inputs;
  const std::vector<Eigen::VectorXd>& common_errors;
};

/// All measured points on the scale that the learning months' design gives.
/// @param error_sd  Of the emulator.
[[nodiscard]] calibration::PosteriorData data_of_all(
    const FollowedSite& followed, const calibration::Normalisation& normalisation,
    const Eigen::VectorXd& error_sd);

/// Outputs that no parameter moves, at the prior modes; without those that the model has at
/// nothing.
[[nodiscard]] std::vector<LevelOutput> levels_of(const FollowedSite& followed);

}  // namespace recald::drift
