/// Decides which readings of a month are rejected, and why.
///
/// A rejected reading becomes `suspect` with its reason and keeps its value, because a
/// fault is a finding.
#pragma once

#include <chrono>
#include <optional>

#include "core/metering/months/month_slots.hpp"
#include "core/metering/reading.hpp"

namespace recald::metering {

struct ValidationOptions {
  double range_factor = 1.2;  ///< Times `rated_kW`: the largest accepted value.
  /// Without `rated_kW`: times the median of the month's positive readings. Monthly profiles of
  /// real meters stay under 10 (a school with an empty summer); a wrong word order or a unit slip
  /// of 1000 is above 100.
  double unrated_range_factor = 20.0;
  /// … and times the largest accepted reading of earlier months, so that the first cold week after
  /// a summer of standby is not refused.
  double unrated_history_factor = 2.0;
  double spike_rise = 1.8;    ///< (highest − third highest) / third highest of a local day.
  double spike_scales = 8.0;  ///< … and this many robust scales from the median of its time of day.
  int spike_days_around = 7;  ///< Readings of the same size within these days confirm a spike.
  /// Readings this close to a negative one may belong to the same register correction.
  std::chrono::seconds correction_window{6 * 3600};
  int stuck_intervals = 12;  ///< Used if the meter has no `stuck_max`.
};

/// What surrounds the month: a run of zeros does not stop at midnight.
struct ValidationContext {
  const MonthSlots* before = nullptr;         ///< The previous month as received, if known.
  const MonthSlots* after = nullptr;          ///< The following month as far as received, if known.
  std::optional<double> largest_believed_kW;  ///< Over earlier months.
};

/// The reason to doubt a reading regardless of others: `range` above the rating, `negative` below
/// zero if the meter cannot run backwards; `none` if the decision needs the month.
[[nodiscard]] Reason doubt_of(double mean_kW, const Meter& meter, const ValidationOptions& options);

/// Turns `ok` slots into `suspect` if a check fails; other slots do not change.
///
/// - range: above 1.2 × rated_kW; without a rating above both `unrated_` limits, unless readings of
///   about the size come on another day as well, as of a car that is charged. They do not count
///   where nearly all of a day lies above the limit, which is a slip of units, nor single ones of
///   exactly the same value, which are a device's word for none.
/// - negative: below zero if the meter cannot run backwards.
/// - range beside a negative: meters and operators correct a register by a large negative interval
///   and large positive ones around it. Within `correction_window` of a negative interval, a
///   reading above the largest one elsewhere in the month is part of the correction. So a
///   correction is never a peak, and ordinary readings beside it stay.
/// - spike: both conditions, and nothing confirms the reading. The robust scale is 1.4826 MAD of
///   the time of day in the month, but at least 1 % of the month's median, so that a constant load
///   may still step, and at least one step of a coarse register. A counter confirms it unless the
///   register falls back afterwards. So do two readings between half and twice its size on the days
///   around, at any time of day. One is enough if half of the month's readings are 0 or a few
///   register steps, as with a boiler's gas meter.
/// - stuck and zero_run: runs of equal values that reach the meter's limit, across month ends;
///   blanks inside neither break a run nor count in it. A value that comes back in three such runs,
///   here and in the months beside, is a load that takes just so much. Never of a counter: at rest
///   it has measured a zero.
///
/// O(slots). No state: the same month and neighbours give the same verdict.
/// @see CalTRACK 2.2.1.4 for zeros; Hyndman's and utilities' spike rule with 180 %.
void validate(MonthSlots& month, const Meter& meter, const ValidationContext& context,
              const ValidationOptions& options);

}  // namespace recald::metering
