/// Time that runs faster than the world's, for trials with simulated meters: a value that two
/// programs can share, so that a month passes in both of them in the same minute.
#pragma once

#include <chrono>
#include <string_view>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::metering {

/// Simulated time = start + (real − anchor) × speed.
struct TrialClock {
  Instant start;
  Instant anchor;      ///< The real time at which it is `start`.
  double speed = 1.0;  ///< Simulated seconds in a real one, > 0.

  using Milliseconds = std::chrono::sys_time<std::chrono::milliseconds>;
  /// A real millisecond can be half a simulated minute.
  using Microseconds = std::chrono::sys_time<std::chrono::microseconds>;

  [[nodiscard]] Milliseconds simulated(Microseconds real) const;
  /// How long a wait of simulated time really takes, at least a nanosecond of it when any.
  [[nodiscard]] std::chrono::nanoseconds real_wait(std::chrono::milliseconds simulated_wait) const;
};

/// "2026-01-30T00:00:00Z@1769900000x600": start, anchor in seconds since 1970, speed.
/// @return or malformed with what is wrong with the text.
[[nodiscard]] Result<TrialClock> parse_trial_clock(std::string_view text);

}  // namespace recald::metering
