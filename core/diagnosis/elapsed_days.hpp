/// Time as counted for the dates of effects.
#pragma once

#include "core/diagnosis/effect.hpp"

namespace recald::diagnosis::effects {

inline constexpr double kDaysPerYear = 365.25;

/// Local days since the day of the first hour, with the local hour as fraction; never decreases.
[[nodiscard]] inline double elapsed_days(const model::DriverHour& hour) {
  return hour.day_index + hour.local_hour / 24.0;
}

/// Local days that the drivers span, first to last.
[[nodiscard]] inline double spanned_days(const model::Drivers& drivers) {
  return drivers.hours.empty() ? 1.0 : drivers.hours.back().day_index + 1.0;
}

}  // namespace recald::diagnosis::effects
