/// A meter whose clock is wrong.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/model/drivers.hpp"

namespace recald::diagnosis::effects {

/// The record with each interval showing what happened `shift_hours` later, power_kW(t + shift).
///
/// Part of an interval is taken from its neighbour, which is exact if power is constant within each
/// interval. Beyond the ends of a stretch of adjacent hours its first or last value continues.
///
/// @param power_kW  A whole number of values for each hour.
[[nodiscard]] inline std::vector<double> shifted_record(std::span<const model::DriverHour> hours,
                                                        std::span<const double> power_kW,
                                                        double shift_hours) {
  std::vector<double> shifted(power_kW.begin(), power_kW.end());
  if (hours.empty()) return shifted;
  const std::size_t steps_per_hour = power_kW.size() / hours.size();
  std::size_t first_hour = 0;
  while (first_hour < hours.size()) {
    std::size_t end_hour = first_hour + 1;
    while (end_hour < hours.size() &&
           hours[end_hour].start - hours[end_hour - 1].start == std::chrono::hours{1}) {
      ++end_hour;
    }
    const std::size_t first = first_hour * steps_per_hour;
    const std::size_t last = end_hour * steps_per_hour - 1;
    for (std::size_t i = first; i <= last; ++i) {
      const double position =
          std::clamp(static_cast<double>(i) + shift_hours * static_cast<double>(steps_per_hour),
                     static_cast<double>(first), static_cast<double>(last));
      const auto before = static_cast<std::size_t>(position);
      const double part = position - static_cast<double>(before);
      const std::size_t after = std::min(before + 1, last);
      shifted[i] = power_kW[before] + part * (power_kW[after] - power_kW[before]);
    }
    first_hour = end_hour;
  }
  return shifted;
}

}  // namespace recald::diagnosis::effects
