/// What measured points say of each other at one draw of the posterior after another.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/calibration/covariance/conditional.hpp"
#include "core/calibration/covariance/error_covariance.hpp"
#include "core/calibration/covariance/hyper_prior.hpp"
#include "core/calibration/posterior/draws.hpp"
#include "core/calibration/posterior/posterior.hpp"
#include "core/result.hpp"

namespace recald::calibration {

/// A normal density of one number.
struct PointNormal {
  double mean;
  double sd;
};

/// Sigma^-1 of the points, made once a draw, and the residuals r = y - f(theta) of that draw. All
/// on the normalised scale.
class PointsAtDraw {
 public:
  PointsAtDraw(const PosteriorData& data, const HyperPrior& prior);

  /// @param row       Of the chain's draws: its hyper-parameters are taken.
  /// @param residual  r (m) at that draw.
  /// @return not_positive_definite when Sigma has no factor; not_finite when r is not finite.
  [[nodiscard]] Result<void> go_to(const ChainDraws& chain, Eigen::Index row,
                                   const Eigen::VectorXd& residual);

  // All below are of the draw gone to last.

  /// Residuals of the points `asked`, given those of all others.
  [[nodiscard]] ConditionalNormal given_others(const std::vector<Eigen::Index>& asked) const {
    return condition(precision_, residual_, weighted_, asked);
  }
  /// The same of a single point, without a matrix.
  [[nodiscard]] PointNormal given_others(Eigen::Index point) const;
  /// log density of the residuals of the points `asked`, given those of all others.
  [[nodiscard]] double log_score(const std::vector<Eigen::Index>& asked) const {
    return log_density_given_others(precision_, weighted_, asked);
  }

 private:
  std::unique_ptr<ErrorCovariance> covariance_;
  Eigen::VectorXd residual_;
  Eigen::MatrixXd precision_;
  Eigen::VectorXd weighted_;  ///< Sigma^-1 r
};

}  // namespace recald::calibration
