/// Finds combinations of parameters that the data did not inform.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/calibration/posterior/draws.hpp"
#include "core/calibration/posterior/findings.hpp"
#include "core/calibration/posterior/posterior.hpp"
#include "core/model/parameter.hpp"

namespace recald::calibration {

/// A direction in units of prior standard deviations, of length 1.
struct WeakDirection {
  Eigen::VectorXd loadings;  ///< (q)
  double information;  ///< Of the data, relative to the prior's; below 1 for a weak direction.
};

/// Eigenvectors of  S J' Sigma^-1 J S + I  with eigenvalues below 2, where the data give less
/// information than the prior. J holds the derivatives of the model's outputs at the posterior
/// mean, S the prior standard deviations; Sigma is taken at the posterior medians of the
/// hyper-parameters.
///
/// @param posterior  Its factor is replaced.
/// @param mean       (q) in the parameters' units.
/// @return weakest first; empty when the covariance has no factor there.
[[nodiscard]] std::vector<WeakDirection> find_weak_directions(Posterior& posterior,
                                                              const std::vector<ChainDraws>& chains,
                                                              const Eigen::VectorXd& mean);

/// `weak_direction`: one finding that names them all, or none.
[[nodiscard]] Findings weak_direction_findings(const std::vector<WeakDirection>& directions,
                                               const std::vector<Parameter>& parameters);

}  // namespace recald::calibration
