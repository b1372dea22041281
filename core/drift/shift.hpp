/// How far a posterior has moved.
#pragma once

#include <Eigen/Core>

namespace recald::drift {

/// Between the draws of one quantity before and now. Both are posteriors of months that do not
/// overlap: of windows that share months the differences are correlated and all of this is wrong.
struct Shift {
  double standardised;  ///< Difference of the means in units of sqrt(sd_now^2 + sd_then^2).
  double hellinger;     ///< Of normals with these means and sds, 0 equal … 1 nothing in common.
  double wasserstein;   ///< Mean distance that draws must be moved, in the quantity's unit.
  double increased;     ///< P(now > then).
};

/// @param then, now  Equally weighted draws, any numbers of them, at least 2 each; not all equal.
/// @note  O(n log n).
[[nodiscard]] Shift shift_between(const Eigen::VectorXd& then, const Eigen::VectorXd& now);

}  // namespace recald::drift
