/// How good a band was: narrow, and missed seldom and by little.
#pragma once

namespace recald::assessment {

struct Interval {
  double low;
  double high;
};

/// Interval score of a central interval, in the unit of the values; smaller is better, 0 is
/// perfect.
///
///     S = (u - l) + 2/alpha max(0, l - y) + 2/alpha max(0, y - u)
///
/// Proper: nobody gains by stating other than his alpha/2 and 1 - alpha/2 quantiles.
/// @param interval  [l, u], finite. @pre l <= u, 0 < coverage < 1
/// @param coverage  1 - alpha: 0.9 for the interval from the 5 % to the 95 % quantile.
/// @param measured  y, finite, same unit.
/// @see Gneiting, Raftery (2007), J. Am. Stat. Assoc. 102(477), eq. (43).
[[nodiscard]] double interval_score(const Interval& interval, double coverage, double measured);

}  // namespace recald::assessment
