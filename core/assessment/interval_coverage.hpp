/// How often an interval held what was measured.
#pragma once

#include <span>

#include "core/result.hpp"

namespace recald::assessment {

struct IntervalCoverage {
  int inside;
  int n;  ///< Points compared.

  [[nodiscard]] double share() const { return static_cast<double>(inside) / n; }
};

/// Counts the measured points within [lower_i, upper_i].
///
/// @param measured  (n) any unit; NaN marks a point that was not measured and is left out.
/// @param lower     (n) same unit. @param upper (n) same unit, lower <= upper.
/// @pre    equal lengths.
/// @return the count, or
///         not_enough_data  no measured point at all;
///         not_finite       a bound that is needed is NaN;
///         invalid_value    a lower bound above its upper bound.
[[nodiscard]] Result<IntervalCoverage> interval_coverage(std::span<const double> measured,
                                                         std::span<const double> lower,
                                                         std::span<const double> upper);

}  // namespace recald::assessment
