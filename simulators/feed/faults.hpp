/// What goes wrong between a meter and its file, planned ahead so that it can be declared.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "simulators/chance/chance.hpp"

namespace recald::simulators {

enum class FaultKind : std::uint8_t {
  gap,       ///< Rows are absent.
  blank,     ///< Rows are there, the value is empty.
  stuck,     ///< The last good value repeats.
  zero,      ///< A dead transmitter reports 0.
  spike,     ///< Far beyond anything the meter's pipe or cable can carry.
  negative,  ///< Below zero.
};

[[nodiscard]] std::string_view to_string(FaultKind kind);

/// Slots [first, first + count) of a recording are hit.
struct Fault {
  FaultKind kind;
  std::size_t first;
  std::size_t count;
};

/// How often and how long. Lengths are drawn between `shortest` and `longest`, short ones likelier.
struct FaultHabit {
  FaultKind kind;
  double per_year;
  double shortest_h;
  double longest_h;
};

/// A meter that is looked after.
[[nodiscard]] std::vector<FaultHabit> healthy_habits();
/// The condensate meter in the steam pit.
[[nodiscard]] std::vector<FaultHabit> steam_pit_habits();
/// A logger that loses its connection, and nothing worse.
[[nodiscard]] std::vector<FaultHabit> gap_habits();
[[nodiscard]] std::vector<FaultHabit> weather_station_habits();

/// Draws faults that do not touch each other, ordered by slot. The first half day stays whole.
/// @param lost_months  this many times, 17 to 27 days in a row are missing altogether.
[[nodiscard]] std::vector<Fault> plan_faults(const std::vector<FaultHabit>& habits, int lost_months,
                                             std::size_t slots, Rng& rng);

}  // namespace recald::simulators
