/// The conditional distribution of some jointly normal points, given the others.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace recald::calibration {

struct ConditionalNormal {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// Distribution of the residuals of the points `asked`, given those of all others:
///
///     r_a | r_b ~ N( r_a - P_aa^-1 (P r)_a,  P_aa^-1 ) = N( -P_aa^-1 P_ab r_b,  P_aa^-1 )
///
/// so the given values of r_a do not matter.
///
/// @param precision          P = Sigma^-1 (m x m), whole.
/// @param residual           r (m)
/// @param weighted_residual  P r (m)
/// @param asked              Indices of points, at least one.
/// @see Rue, Held (2005), Gaussian Markov Random Fields, theorem 2.5.
[[nodiscard]] ConditionalNormal condition(const Eigen::MatrixXd& precision,
                                          const Eigen::VectorXd& residual,
                                          const Eigen::VectorXd& weighted_residual,
                                          const std::vector<Eigen::Index>& asked);

/// log density of the residuals of the points `asked`, given those of all others.
/// @see Bürkner, Gabry, Vehtari (2021), Comput. Stat. 36, eq. (15), for single points.
[[nodiscard]] double log_density_given_others(const Eigen::MatrixXd& precision,
                                              const Eigen::VectorXd& weighted_residual,
                                              const std::vector<Eigen::Index>& asked);

}  // namespace recald::calibration
