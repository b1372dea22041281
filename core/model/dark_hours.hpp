/// When lamps outdoors burn.
#pragma once

#include <algorithm>

#include "core/model/drivers.hpp"

namespace recald::model {

/// Part of the hour in which the sun is 2 degrees or more below the horizon, 0…1.
[[nodiscard]] inline double dark_share(const DriverHour& hour) {
  constexpr double kSwitchingSine = -0.0349;  // sine of -2 degrees
  // The sine of the sun's altitude moves so much in the hour about sunset at middle latitudes.
  constexpr double kSinePerHour = 0.2;
  return std::clamp(0.5 - (hour.sine_of_sun_altitude - kSwitchingSine) / kSinePerHour, 0.0, 1.0);
}

}  // namespace recald::model
