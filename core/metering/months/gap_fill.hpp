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
  /// Of longer gaps the variance of whole days is used.
  std::chrono::seconds by_slots_gap_max{24 * 3600};
};

struct FillResult {
  int filled = 0;              ///< Slots whose used value is an estimate.
  double variance_kWh2 = 0.0;  ///< Of the month's energy, from the estimates alone.
};

/// Sets `used_kW` of every slot: its measured value if `ok` or `scaled`, otherwise an estimate.
/// `missing` slots become `filled`; `suspect` ones stay suspect, with an estimate beside the value.
/// A month without any measured slot gets no estimates.
///
/// A building that draws more than usual does so for hours: within a gap errors are taken to be
/// fully correlated, from gap to gap to be independent. With n days measured at a time of day,
/// sample variance s² and J slots filled from that mean, h the interval in hours,
///   Var += (Σ s h)² over each gap, and s² J²/n h² for the error of the mean they share,
/// without the latter where a line fills the gap. Gaps longer than `by_slots_gap_max` use the daily
/// means of complete days instead, D days missing of n_d:
///   Var += s_day² (D + D²/n_d) (24 h)².
/// @see the seed, section 2, for the estimate.
[[nodiscard]] FillResult fill_gaps(MonthSlots& month, const FillOptions& options);

}  // namespace recald::metering
