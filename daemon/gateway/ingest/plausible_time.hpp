/// Whether a clock shows a plausible time.
#pragma once

#include <chrono>

#include "core/metering/civil_time.hpp"

namespace recald::daemon {

/// A gateway without a clock battery starts in 1970 until its clock is set.
inline constexpr metering::Instant kEarliestTime =
    std::chrono::sys_days{std::chrono::year{2024} / std::chrono::January / 1};

/// Whether a clock can be right; a time outside this range means that it was not set.
[[nodiscard]] inline bool is_plausible_time(metering::Instant now) {
  return kEarliestTime <= now && now < metering::kLatestInstant - std::chrono::days{62};
}

}  // namespace recald::daemon
