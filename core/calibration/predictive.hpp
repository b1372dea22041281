/// Predictive draws of the measured points and their log-likelihoods, for programs that compare
/// models and check them, such as ArviZ.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/calibration/posterior/draws.hpp"
#include "core/calibration/posterior/posterior.hpp"
#include "core/calibration/sampling.hpp"
#include "core/result.hpp"

namespace recald::calibration {

/// Of one chain, a row a draw.
struct ChainPredictions {
  Eigen::MatrixXd replicates;      ///< (n x m) y_rep in the outputs' units.
  Eigen::MatrixXd log_likelihood;  ///< (n x m) log density of what was measured, in 1/unit.
};

struct PointPredictions {
  std::vector<PointIndex> points;  ///< (m) Fitted and measured, ordered by output, then month.
  std::vector<ChainPredictions> chains;
};

/// For each draw (theta, phi) and each point i the density p(y_i | y_-i, theta, phi): its log at
/// what was measured, and one number drawn from it.
///
/// The likelihood is one normal density of all points, which the discrepancy and the common errors
/// correlate: given (theta, phi) it has no factor for each point. With P = Sigma^-1 and
/// r = y - f(theta),
///
///     y_i | y_-i, theta, phi ~ N( y_i - (P r)_i / P_ii,  1 / P_ii )
///
/// is what a point has of its own. Importance weights from its log are those of leaving one point
/// out, and the numbers drawn, with these weights, are forecasts of points not seen. Numbers of one
/// draw are not together a draw of all points. Sigma and f are those that were sampled: weights
/// below one, the error of a meta-model or of an emulator and its means are in them. Densities are
/// of figures in units: that of a normalised figure, divided by the range of its output.
///
/// @param prototype  The posterior that the chains are of.
/// @param context    Chain k draws from a stream of its own; any executor gives the same bytes.
/// @return or not_positive_definite, not_finite or cancelled.
/// @note   One factorisation and one run of the model a draw.
/// @see    Bürkner, Gabry, Vehtari (2021), Comput. Stat. 36, eq. (15).
[[nodiscard]] Result<PointPredictions> predict_points(const Posterior& prototype,
                                                      const std::vector<ChainDraws>& chains,
                                                      const RunContext& context);

}  // namespace recald::calibration
