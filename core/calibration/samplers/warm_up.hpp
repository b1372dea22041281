/// How a Hamiltonian sampler learns the shape of a density during warm-up.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace recald::calibration {

/// The times at which a warm-up takes a new metric. A fast start finds the density. Then follow
/// windows that each double in length and end with a new metric. A fast end adapts the step size to
/// the last of them. With 150 iterations or more the start takes 75, the first window 25 and the
/// end 50 (as in Stan); with fewer the start takes 15 %, the end 10 %. A window is extended to the
/// end if the next would not fit.
///
/// @param has_metric  The chain begins with a learnt metric, so no window has to be fast.
/// @return iterations (from 1) after which a window ends, ascending, each <= burn_in; the first
///         ends the fast start and gives no metric. Empty for fewer than 20 iterations.
[[nodiscard]] std::vector<int> window_ends(int burn_in, bool has_metric);

/// Estimates the metric from a window's points and forces.
///
/// For a normal density the covariance C of the points and the covariance G of the gradients of the
/// log density are each other's inverse. With few points either is a poor estimate. But the A that
/// satisfies A G A = C, their geometric mean C # G^-1, is exact for a normal density as soon as
/// there are more points than dimensions, wherever the chain came from; in general it minimises the
/// Fisher divergence between the density and a normal one. Both covariances are shrunk towards the
/// present metric by the weight of one point, which keeps them invertible; Stan's five, meant for C
/// alone, would cost a tenth of the effective draws per gradient.
///
/// @see Seyboldt, Carlson, Carpenter (2024), "Preconditioning Hamiltonian Monte Carlo by minimizing
///      Fisher divergence".
class MetricEstimator {
 public:
  /// @param capacity  Number of points in the longest window.
  MetricEstimator(Eigen::Index dimension, Eigen::Index capacity);

  /// @param position  (d) in the target's coordinates.
  /// @param force     (d) L' times the gradient, where L is the factor of the present metric.
  void add(const Eigen::VectorXd& position, const Eigen::VectorXd& force);
  void restart() { count_ = 0; }

  /// @param factor  L of the present metric, lower triangular.
  /// @return the lower triangular factor of the new metric; the present one for fewer than two
  ///         points, or if rounding leaves nothing positive definite.
  [[nodiscard]] Eigen::MatrixXd factor(const Eigen::MatrixXd& factor) const;

 private:
  Eigen::MatrixXd positions_;  ///< (d x capacity)
  Eigen::MatrixXd forces_;     ///< (d x capacity)
  Eigen::Index count_ = 0;
};

}  // namespace recald::calibration
