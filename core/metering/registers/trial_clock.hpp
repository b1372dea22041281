/// Time that runs faster than real time, for trials with simulated meters. Two programs can share
/// the value, so that a month takes the same real minute in both.
#pragma once

#include <chrono>
#include <string_view>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::metering {

/// Simulated time = start + (real − anchor) × speed.
struct TrialClock {
  Instant start;
  Instant anchor;      ///< The real time that corresponds to `start`.
  double speed = 1.0;  ///< Simulated seconds per real second, > 0.

  using Milliseconds = std::chrono::sys_time<std::chrono::milliseconds>;
  /// A real millisecond can be half a simulated minute.
  using Microseconds = std::chrono::sys_time<std::chrono::microseconds>;

  [[nodiscard]] Milliseconds simulated(Microseconds real) const;
  /// The real duration of a simulated wait; at least a nanosecond unless it is zero.
  [[nodiscard]] std::chrono::nanoseconds real_wait(std::chrono::milliseconds simulated_wait) const;
};

/// "2026-01-30T00:00:00Z@1769900000x600": start, anchor in seconds since 1970, speed.
/// @return the clock, or malformed with the mistake in the text.
[[nodiscard]] Result<TrialClock> parse_trial_clock(std::string_view text);

}  // namespace recald::metering
