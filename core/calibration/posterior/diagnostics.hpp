/// Whether chains agree, and how many independent draws they are worth.
///
/// Vehtari, Gelman, Simpson, Carpenter, Bürkner (2021), Bayesian Analysis 16(2):
/// "Rank-normalization, folding, and localization". Same definitions as R's package posterior.
#pragma once

#include <Eigen/Core>

namespace recald::calibration {

/// All diagnostics of one scalar quantity. `draws` is (iterations x chains), iterations >= 8. A
/// quantity that is the same in every draw, or not finite, has R-hat infinity and ESS 0.
struct Diagnostics {
  double rhat;      ///< Larger of the rank-normalised split R-hat and that of the folded draws.
  double ess_bulk;  ///< Effective draws for the centre.
  double ess_tail;  ///< Smaller of the effective draws for the 5 % and 95 % quantiles.
  double mcse;      ///< Monte Carlo standard error of the mean, in the quantity's unit.
};

[[nodiscard]] Diagnostics diagnose(const Eigen::MatrixXd& draws);

/// Effective sample size of the mean of (iterations x chains), without splitting or ranks. Geyer's
/// initial monotone sequence over autocovariances averaged over chains (ibid., section 3).
[[nodiscard]] double effective_sample_size(const Eigen::MatrixXd& draws);

}  // namespace recald::calibration
