/// The evidence of a model from draws of its posterior, by bridge sampling.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "core/calibration/samplers/sampler.hpp"

namespace recald::calibration {

struct BridgeEstimate {
  double log_evidence;  ///< log of the integral of the target's density.
  double mcse;          ///< Monte Carlo standard error of `log_evidence`.
  int iterations;  ///< Of the fixed point; dozens mean that density and proposal hardly overlap.
};

/// log of the integral of exp(log_density), by warp-III bridge sampling.
///
/// A normal density is fitted to one half of the draws: mean mu, covariance L L'. In u = L^-1 (z -
/// mu) the density is made symmetric, q(u) = |L| (p(mu + L u) + p(mu - L u)) / 2, which keeps its
/// integral and removes its skewness. It is bridged to the standard normal density g by the optimal
/// function of Meng and Wong, the fixed point of
///
///     r = mean over g of [q / (s_1 q + s_2 r g)]
///         / mean over the other half of [g / (s_1 q + s_2 r g)]
///
/// with s_1 : s_2 the effective sizes of the two samples. The halves are kept apart because a
/// proposal evaluated on the draws it was fitted to overestimates the evidence.
///
/// The standard error is that of r's two means, the posterior one with its autocorrelation. It does
/// not account for a mode that no draw has visited.
///
/// @param draws  (n x d) in the target's coordinates, chains one below the other: the proposal is
///               fitted to the first half and evaluated on the second, so on other chains.
/// @return the estimate; not_enough_data for n < 4 (d + 2), not_positive_definite for draws without
///         spread, not_finite if the fixed point is not found, or an error of the target.
/// @param proceed  Called with each evaluation; false gives `cancelled`.
/// @note   2 n evaluations of the density.
/// @see    Meng, Wong (1996), Statistica Sinica 6; Meng, Schilling (2002), J. Comput. Graph. Stat.
///         11(3) for the warp; Frühwirth-Schnatter (2004), Econom. J. 7(1) for the error.
[[nodiscard]] Result<BridgeEstimate> bridge_log_evidence(Target& target,
                                                         const Eigen::MatrixXd& draws, Rng& rng,
                                                         const std::function<bool()>& proceed = {});

}  // namespace recald::calibration
