/// How well the posterior predicts left-out months, without refitting.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "core/calibration/posterior/draws.hpp"
#include "core/calibration/posterior/posterior.hpp"
#include "core/result.hpp"

namespace recald::calibration {

/// Points that are left out together, as indices into the posterior's points.
using PointBlocks = std::vector<std::vector<Eigen::Index>>;

/// The points of each block of `months` consecutive months in use, all outputs together.
/// @pre months >= 1
[[nodiscard]] PointBlocks blocks_of_months(const std::vector<PointIndex>& points, int months);

/// log p(y_b | y_rest, theta, phi) of each block b for equally spaced draws, (draws x blocks).
///
/// Points are correlated through the discrepancy, so the density of a block given all others is
/// Gaussian with precision P_bb and residual P_bb^-1 (P r)_b, P = Sigma^-1.
///
/// @param posterior  The one that the chains are of.
/// @param count      Draws taken, pooled over chains.
/// @param proceed    Called with each draw; false gives `cancelled`.
/// @return not_enough_data without a block, not_positive_definite when a draw's covariance has no
///         factor, an error of the model.
/// @see Bürkner, Gabry, Vehtari (2021), Comput. Stat. 36, eq. (15), for single points.
[[nodiscard]] Result<Eigen::MatrixXd> block_log_scores(Posterior& posterior,
                                                       const std::vector<ChainDraws>& chains,
                                                       int count, const PointBlocks& blocks,
                                                       const std::function<bool()>& proceed = {});

/// Draws that are enough for it.
inline constexpr int kLeaveOutDraws = 1000;

/// Expected log density of left-out blocks, by importance sampling from the whole posterior.
struct LeaveOutScore {
  int block_months;
  int blocks;
  double elpd;            ///< Sum over blocks of log p(y_b | y_rest), on the normalised scale.
  double standard_error;  ///< Of the sum.
  double pareto_k_max;    ///< Above 0.7, that block would have to be refitted.
  int unreliable;         ///< Blocks with k above 0.7.
};

/// PSIS over blocks of `months` consecutive months. Single months borrow from their neighbours,
/// because discrepancies of adjacent months are correlated; longer blocks test prediction.
/// @param proceed  Called with each draw; false gives `cancelled`.
[[nodiscard]] Result<LeaveOutScore> leave_out_score(Posterior& posterior,
                                                    const std::vector<ChainDraws>& chains,
                                                    int months, int count = kLeaveOutDraws,
                                                    const std::function<bool()>& proceed = {});

}  // namespace recald::calibration
