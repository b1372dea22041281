/// A counter held against the power that the same meter shows: each tells on the other.
#pragma once

#include <vector>

#include "core/metering/reading.hpp"

namespace recald::metering {

struct PowerCheckRules {
  double rated_kW = 0.0;
  double resolution_kWh = 0.0;     ///< Step of the counter.
  double load_share = 0.05;        ///< Of the rating: a power above it must move the counter.
  int standing_intervals = 4;      ///< A counter that stands this long under load is frozen.
  int compared_intervals = 96;     ///< Energies are compared over so many: a day of quarters.
  double difference_share = 0.05;  ///< … and may differ by so much.
};

/// What is known so far. Begins anew after a restart.
struct PowerCheck {
  std::vector<Reading> standing;  ///< Intervals of the counter without energy, under load.
  double standing_kWh = 0.0;      ///< What the power says of them.
  int compared = 0;
  double counted_kWh = 0.0;
  double powered_kWh = 0.0;
};

struct PowerVerdict {
  /// Intervals that were booked as measured and are frozen: suspect, reason `stuck`. They take the
  /// place of what was booked.
  std::vector<Reading> frozen;
  bool has_frozen_now = false;  ///< The first such intervals of a run.
  /// Energy by the power over that by the counter, at the end of a comparison that failed; else 0.
  double power_to_counter = 0.0;
};

/// Enters one interval as both have it.
///
/// - stuck: the power was above 5 % of the rating and the counter stood, for four intervals, though
///   the power's energy is more than two of its steps.
/// - cross: over a day the energies differ by more than 5 % and more than two steps. A power that
///   is 0 all day is one that the device does not give.
///
/// Intervals that are not `ok` on both sides say nothing: they end a run and are not compared. Nor
/// do those with a negative power: what is exported is counted elsewhere.
/// @pre counted.start == powered.start
[[nodiscard]] PowerVerdict check_power(PowerCheck& check, const Reading& counted,
                                       const Reading& powered, std::chrono::seconds interval,
                                       const PowerCheckRules& rules);

}  // namespace recald::metering
