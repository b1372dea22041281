/// How far a posterior has moved, and whether it would have anyway.
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
  /// Of a difference as large where nothing has moved. Two posteriors of the same truth differ by
  /// less than their sds say, as both lean on one prior: a mean scatters by S (1 - S / V) about the
  /// truth's share of it, S and V the posterior's and the prior's variance.
  double pvalue;
};

/// @param then, now       Equally weighted draws, any numbers of them, at least 2 each; not all
/// equal.
/// @param prior_variance  Of the prior that both started from.
/// @note  O(n log n).
[[nodiscard]] Shift shift_between(const Eigen::VectorXd& then, const Eigen::VectorXd& now,
                                  double prior_variance);

}  // namespace recald::drift
