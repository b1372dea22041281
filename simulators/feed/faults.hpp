/// Faults between a meter and its file, planned in advance so that they can be declared.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "simulators/chance/chance.hpp"

namespace recald::simulators {

enum class FaultKind : std::uint8_t {
  gap,       ///< Rows are missing.
  blank,     ///< Rows are there, but the value is empty.
  stuck,     ///< The last good value repeats.
  zero,      ///< A dead transmitter reports 0.
  spike,     ///< Far beyond the capacity of the meter's pipe or cable.
  negative,  ///< Below zero.
};

[[nodiscard]] std::string_view to_string(FaultKind kind);

/// A fault in slots [first, first + count) of a recording.
struct Fault {
  FaultKind kind;
  std::size_t first;
  std::size_t count;
};

/// How often and how long. Lengths are drawn between `shortest` and `longest`, short
/// ones more often.
struct FaultHabit {
  FaultKind kind;
  double per_year;
  double shortest_h;
  double longest_h;
};

/// A well-maintained meter.
[[nodiscard]] std::vector<FaultHabit> healthy_habits();
/// The condensate meter in the steam pit.
[[nodiscard]] std::vector<FaultHabit> steam_pit_habits();
/// A logger that only loses its connection.
[[nodiscard]] std::vector<FaultHabit> gap_habits();
[[nodiscard]] std::vector<FaultHabit> weather_station_habits();

/// Draws faults that do not touch each other, ordered by slot. The first half day has none.
/// @param lost_months  Number of times that 17 to 27 days in a row are missing.
[[nodiscard]] std::vector<Fault> plan_faults(const std::vector<FaultHabit>& habits, int lost_months,
                                             std::size_t slots, Rng& rng);

}  // namespace recald::simulators
