/// Spans of time as counted for effects.
#pragma once

#include "core/diagnosis/effects/support/effect.hpp"

namespace recald::diagnosis::effects {

inline constexpr double kDaysPerYear = 365.25;

/// Local days that the drivers span, first to last.
[[nodiscard]] inline double spanned_days(const model::Drivers& drivers) {
  return drivers.hours.empty() ? 1.0 : drivers.hours.back().day_index + 1.0;
}

}  // namespace recald::diagnosis::effects
