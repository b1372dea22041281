#include "core/drift/followed_data.hpp"

#include <algorithm>

#include "core/absent.hpp"
#include "core/calibration/posterior/emulator.hpp"

namespace recald::drift {
namespace {

/// What is known of each point's error, as the mean over the outputs of its month: then the
/// covariance comes apart by outputs, and its factor, of which a sequence takes a million, costs a
/// tenth. The known part (filled gaps, the emulator) is small beside what is learnt.
void share_by_month(calibration::PosteriorData& data) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(data.month_inputs.rows());
  Eigen::VectorXd counts = sums;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    sums(data.points[i].month) += data.extra_variances(static_cast<Eigen::Index>(i));
    counts(data.points[i].month) += 1.0;
  }
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const int month = data.points[i].month;
    data.extra_variances(static_cast<Eigen::Index>(i)) = sums(month) / counts(month);
  }
}

}  // namespace

calibration::PosteriorData data_of_all(const FollowedSite& followed,
                                       const calibration::Normalisation& normalisation,
                                       const Eigen::VectorXd& error_sd) {
  const assessment::AssessedCalibration& site = followed.site;
  calibration::CalibrationProblem all = assessment::problem_of(site, site.month_names.size());
  for (std::size_t k = 0; k < all.outputs.size(); ++k) {
    if (!site.outputs[k].calibrated) std::ranges::fill(all.outputs[k].values, kAbsent);
  }
  all.inputs = followed.inputs;
  all.common_errors = followed.common_errors;
  calibration::PosteriorData data =
      calibration::normalise_problem(all, normalisation, followed.learning_months);
  calibration::add_emulator_error(error_sd, static_cast<int>(site.month_names.size()), data);
  share_by_month(data);
  return data;
}

std::vector<LevelOutput> levels_of(const FollowedSite& followed) {
  const assessment::AssessedCalibration& site = followed.site;
  const std::vector<double> modelled = evaluate(followed.model, prior_modes(site.parameters));
  const auto months = static_cast<std::ptrdiff_t>(site.month_names.size());
  std::vector<LevelOutput> levels;
  for (std::size_t k = 0; k < site.outputs.size(); ++k) {
    if (site.outputs[k].calibrated) continue;
    const auto first = modelled.begin() + static_cast<std::ptrdiff_t>(k) * months;
    if (std::any_of(first, first + months, [](double value) { return !(value > 0.0); })) continue;
    levels.push_back({static_cast<int>(k), {first, first + months}, site.outputs[k].measured});
  }
  return levels;
}

}  // namespace recald::drift
