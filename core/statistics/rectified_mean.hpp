/// The mean of loads that are never negative: what a plant delivers over a month of unequal hours.
#pragma once

namespace recald {

/// E[max(0, z + s e)] of a standard normal e: s phi(z/s) + z Phi(z/s). Well above zero it is z, far
/// below it is 0, and s is how widely it bends between.
/// @pre s > 0
/// @see Tobin (1958), Econometrica 26(1), the mean of a censored normal.
[[nodiscard]] double rectified_mean(double z, double s);

/// Its derivative with respect to z: Phi(z/s).
[[nodiscard]] double rectified_slope(double z, double s);

/// The z whose rectified mean is y; not below -4 s, where that mean is next to nothing.
/// @pre s > 0
[[nodiscard]] double rectified_inverse(double y, double s);

}  // namespace recald
