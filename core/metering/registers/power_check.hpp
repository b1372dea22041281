/// Compares a meter's counter with its power, to find faults in either.
#pragma once

#include <vector>

#include "core/metering/reading.hpp"

namespace recald::metering {

struct PowerCheckRules {
  double rated_kW = 0.0;
  double resolution_kWh = 0.0;     ///< Step of the counter.
  double load_share = 0.05;        ///< Of the rating: power above it must move the counter.
  int standing_intervals = 4;      ///< A counter that stands still this long under load is frozen.
  int compared_intervals = 96;     ///< Energies are compared over these: a day of quarter hours.
  double difference_share = 0.05;  ///< … and the largest allowed difference.
};

/// The state of the check. Starts again after a restart.
struct PowerCheck {
  std::vector<Reading> standing;  ///< Intervals under load in which the counter stood still.
  double standing_kWh = 0.0;      ///< Their energy according to the power.
  int compared = 0;
  double counted_kWh = 0.0;
  double powered_kWh = 0.0;
};

struct PowerVerdict {
  /// Intervals that were booked as measured and are frozen: suspect, reason `stuck`. They replace
  /// the booked ones.
  std::vector<Reading> frozen;
  bool has_frozen_now = false;  ///< True for the first such intervals of a run.
  /// Energy from the power divided by that from the counter, after a failed comparison; else 0.
  double power_to_counter = 0.0;
};

/// Enters one interval from both sources.
///
/// - stuck: the power was above 5 % of the rating and the counter stood still, for four intervals,
///   although the power's energy is more than two of its steps.
/// - cross: over a day the energies differ by more than 5 % and more than two steps. A power that
///   is 0 all day means that the device does not provide it.
///
/// Intervals that are not `ok` on both sides end a run and are not compared. Neither are those with
/// a negative power, since exports are counted elsewhere.
/// @pre counted.start == powered.start
[[nodiscard]] PowerVerdict check_power(PowerCheck& check, const Reading& counted,
                                       const Reading& powered, std::chrono::seconds interval,
                                       const PowerCheckRules& rules);

}  // namespace recald::metering
