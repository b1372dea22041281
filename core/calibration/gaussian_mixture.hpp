/// A mixture of normal densities fitted to points: a map of a posterior's modes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/random/rng.hpp"

namespace recald::calibration {

/// N(mean, L L') with its weight in a mixture.
struct GaussianComponent {
  double weight;
  Eigen::VectorXd mean;
  Eigen::MatrixXd factor;  ///< L, lower triangle.
  double log_constant;     ///< log weight - 1/2 log|L L'| - d/2 log 2 pi
};

/// sum_k w_k N(m_k, S_k).
class GaussianMixture {
 public:
  /// @pre at least one component, all of one dimension, weights summing to one
  explicit GaussianMixture(std::vector<GaussianComponent> components);

  [[nodiscard]] const std::vector<GaussianComponent>& components() const { return components_; }

  /// Includes the constant. Does not allocate.
  [[nodiscard]] double log_density(const Eigen::VectorXd& point);
  /// @param point  (d), already of that size. Does not allocate.
  void draw(Rng& rng, Eigen::VectorXd& point);

 private:
  std::vector<GaussianComponent> components_;
  Eigen::VectorXd scratch_;  ///< (d)
};

/// Fits by expectation-maximisation, with the number of components of smallest BIC.
///
/// @param points          (n x d), n > d + 1, not all in one plane.
/// @param components_max  >= 1
/// @param rng             Chooses the starting points.
/// @note  O(n components d^2) per iteration. The same points and state of `rng` give the same bits.
/// @see   Dempster, Laird, Rubin (1977), J. R. Stat. Soc. B 39(1).
[[nodiscard]] GaussianMixture fit_mixture(const Eigen::MatrixXd& points, int components_max,
                                          Rng& rng);

/// Widens a fitted mixture for use as a proposal: covariances grow by a fifth, and a tenth of the
/// weight goes to a component with twice the covariance of the whole mixture.
[[nodiscard]] GaussianMixture widen(const GaussianMixture& mixture);

}  // namespace recald::calibration
