/// When outdoor lamps are on.
#pragma once

#include <algorithm>

#include "core/model/drivers.hpp"

namespace recald::model {

/// Part of the hour in which the sun is at least 2 degrees below the horizon, 0…1.
[[nodiscard]] inline double dark_share(const DriverHour& hour) {
  constexpr double kSwitchingSine = -0.0349;  // sine of -2 degrees
  // Change of the sine of the sun's altitude in the hour around sunset at middle latitudes.
  constexpr double kSinePerHour = 0.2;
  return std::clamp(0.5 - (hour.sine_of_sun_altitude - kSwitchingSine) / kSinePerHour, 0.0, 1.0);
}

}  // namespace recald::model
