/// The part of an hour that a longer or shifted plant day covers.
#pragma once

#include <algorithm>

#include "core/model/hourly/alteration.hpp"

namespace recald::diagnosis::effects {

/// Share of an hour that lies within `reach_h` of the plant's start or stop. Grows linearly with
/// the reach, so that a calibration sees a slope and no steps.
/// @param distance_h  From the middle of the hour to the start or stop, as counted by
///                    `DriverHour::hours_to_start` and `hours_since_stop`; 0: the plant runs.
[[nodiscard]] inline double covered_share(double reach_h, double distance_h) {
  if (distance_h <= 0.0) return 0.0;
  return std::clamp(reach_h - (distance_h - 0.5), 0.0, 1.0);
}

/// Keeps at least this share of the daytime rooms at occupied set-points with fans on.
inline void run_at_least(double share, model::hourly::StepOperation& operation) {
  operation.daytime_share = std::max(operation.daytime_share, share);
}

}  // namespace recald::diagnosis::effects
