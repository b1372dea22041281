/// The usual prior of an amount that is never negative.
#pragma once

#include <limits>

#include "core/model/prior.hpp"

namespace recald::diagnosis::effects {

/// Density falls from 0 on; `sd` is that of the normal before truncation at 0, in
/// the amount's unit.
/// @pre sd > 0
[[nodiscard]] inline Prior half_normal(double sd) {
  return TruncatedNormalPrior{
      .location = 0.0, .sd = sd, .min = 0.0, .max = std::numeric_limits<double>::infinity()};
}

}  // namespace recald::diagnosis::effects
