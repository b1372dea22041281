/// Estimates for the slots of a month without measurements, and the uncertainty
/// they add to its sum.
#pragma once

#include <chrono>
#include <vector>

#include "core/metering/months/fill_rule.hpp"
#include "core/metering/months/month_slots.hpp"

namespace recald::metering {

struct FillOptions {
  FillRule rule = FillRule::same_time;
  bool daytype = false;       ///< Average over like days only: working or not. Off, as in the seed.
  std::vector<Day> holidays;  ///< Local days treated as not working.
  std::chrono::seconds line_max{2 * 3600};
  int days_min = 3;  ///< With fewer measured days at a time of day, a wider mean is used.
  /// In longer gaps, errors of slots are not independent: the variance of whole days is used.
  std::chrono::seconds independent_gap_max{24 * 3600};
};

struct FillResult {
  int filled = 0;              ///< Slots whose used value is an estimate.
  double variance_kWh2 = 0.0;  ///< Of the month's energy, from the estimates alone.
};

/// Sets `used_kW` of every slot: its measured value if `ok` or `scaled`, otherwise an estimate.
/// `missing` slots become `filled`; `suspect` ones stay suspect, with an estimate beside the value.
/// A month without any measured slot gets no estimates.
///
/// With n days measured at a time of day, sample variance s² and J slots filled from that mean,
///   Var += s² (J + J²/n) h²,  h the interval in hours:
/// J independent deviations plus the error of the mean they share. Slots of gaps longer than
/// `independent_gap_max` use the daily means of complete days instead, D days missing of n_d:
///   Var += s_day² (D + D²/n_d) (24 h)².
/// A line's errors within its gap are assumed to be fully correlated, (Σ s h)².
/// @see the seed, section 2, for the estimate.
[[nodiscard]] FillResult fill_gaps(MonthSlots& month, const FillOptions& options);

}  // namespace recald::metering
