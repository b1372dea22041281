/// When a unit is polled: tied to the wall clock, but not at the same moment as all others.
///
/// A thousand meters read at one instant wait for each other. So each unit has a phase, a fixed
/// place in the period. It depends on the names in the site file only, so a restart or a reload
/// does not move it.
#pragma once

#include <chrono>
#include <cstddef>
#include <string_view>

namespace recald::daemon {

using WallTime = std::chrono::sys_time<std::chrono::milliseconds>;

class PollTimes {
 public:
  /// A poll is due at every multiple of the period since 1970, shifted by the phase within half a
  /// period before and after it. At each interval boundary one is due within the second after it,
  /// instead of any regular one. A stamp has whole seconds, so such a sample still lies on its
  /// boundary; and since the shift is always the same, an interval keeps its length.
  /// @param phase  In [0, 1), dimensionless. 0: exactly at the multiples and the boundaries.
  PollTimes(std::chrono::milliseconds period, std::chrono::milliseconds interval, double phase);

  /// The first due time after `t`.
  [[nodiscard]] WallTime after(WallTime t) const;

  /// How much later than the others the unit is polled at the start or at a boundary.
  [[nodiscard]] std::chrono::milliseconds boundary_delay() const { return boundary_delay_; }

 private:
  std::chrono::milliseconds period_;
  std::chrono::milliseconds interval_;
  std::chrono::milliseconds shift_;  ///< Of regular polls.
  std::chrono::milliseconds boundary_delay_;
};

/// The phase of a unit. Those of all buses are spread over the whole period. The units of one bus
/// follow each other within a quarter of it: a bus makes one request at a time, and a silent unit
/// is only asked when none that answers falls due meanwhile.
/// @param unit  Index on its bus, < units.
[[nodiscard]] double poll_phase(std::string_view bus, std::size_t unit, std::size_t units);

}  // namespace recald::daemon
