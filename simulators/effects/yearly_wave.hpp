/// The course of the year for effects that follow the seasons.
#pragma once

#include <chrono>
#include <cmath>
#include <numbers>

#include "core/metering/civil_time.hpp"

namespace recald::simulators {

/// −1 on the coldest day, +1 half a year later; shifted by half a year south of the equator.
/// @param coldest_day  Day of the year, 0 for 1 January, for the northern hemisphere.
[[nodiscard]] inline double yearly_wave(metering::Day day, double coldest_day,
                                        double latitude_deg) {
  constexpr double year_days = 365.25;
  const std::chrono::sys_days new_year{day.year() / std::chrono::January / 1};
  const auto days = static_cast<double>((std::chrono::sys_days{day} - new_year).count());
  const double turned_days = latitude_deg < 0.0 ? 0.5 * year_days : 0.0;
  return -std::cos(2.0 * std::numbers::pi * (days - coldest_day - turned_days) / year_days);
}

}  // namespace recald::simulators
