/// The usual priors of amounts and shares.
#pragma once

#include <limits>

#include "core/absent.hpp"
#include "core/diagnosis/effects/support/effect.hpp"

namespace recald::diagnosis::effects {

/// Of an amount that is never negative: density falls from 0 on; `sd` is that of the normal before
/// truncation at 0, in the amount's unit. @pre sd > 0
[[nodiscard]] inline Prior half_normal(double sd) {
  return TruncatedNormalPrior{
      .location = 0.0, .sd = sd, .min = 0.0, .max = std::numeric_limits<double>::infinity()};
}

/// `half_normal` with an upper physical limit. @pre sd > 0, max > 0
[[nodiscard]] inline Prior half_normal_below(double sd, double max) {
  return TruncatedNormalPrior{.location = 0.0, .sd = sd, .min = 0.0, .max = max};
}

/// `share` of the mean of this utility's meter, kW; without one, or if it reads zero, of 10 W per
/// floor area, so that the prior stays proper.
[[nodiscard]] inline double share_of_mean_kW(const SiteFacts& facts, metering::Utility utility,
                                             double share) {
  const double mean_kW = facts.mean_of_kW(utility);
  return share * (mean_kW > 0.0 ? mean_kW : 0.010 * facts.building.floor_area_m2);
}

/// A share of which nothing is known. @param name  snake_case
[[nodiscard]] inline EffectParameter any_share(const char* name, const char* unit) {
  return {.name = name, .unit = unit, .prior = UniformPrior{0.0, 1.0}, .neutral = 0.0};
}

/// A share between two alternatives, tried at both ends. @param name  snake_case
[[nodiscard]] inline EffectParameter either_share(const char* name) {
  return {.name = name,
          .unit = "-",
          .prior = UniformPrior{.min = 0.0, .max = 1.0},
          .neutral = kAbsent,
          .scan = {0.0, 1.0}};
}

/// One of three, chosen and not fitted: 1, 2 or 3. @param unit  What each of them means
[[nodiscard]] inline EffectParameter one_of_three(const char* name, const char* unit) {
  return {.name = name,
          .unit = unit,
          .prior = UniformPrior{0.5, 3.5},
          .neutral = kAbsent,
          .scan = {1.0, 2.0, 3.0},
          .choice = true};
}

}  // namespace recald::diagnosis::effects
