/// From a month's readings to the figures that a model is compared with.
#pragma once

#include <chrono>

#include "core/metering/months/gap_fill.hpp"
#include "core/metering/months/month_slots.hpp"
#include "core/metering/months/monthly_figure.hpp"
#include "core/metering/months/validation.hpp"

namespace recald::metering {

struct ClosingOptions {
  ValidationOptions validation;
  FillOptions fill;
  double coverage_min = 0.6;  ///< Share of measured slots below which a month is unusable.
  std::chrono::seconds gap_max{7 * 86'400};  ///< A longer gap makes the month unusable.
};

struct ClosedMonth {
  std::uint32_t meter;
  MonthlyFigure figure;
  MonthSlots slots;  ///< Validated and filled: the basis of the figure.
};

/// Largest mean over complete blocks of the rule's window, with every slot measured and valid.
/// Blocks start where the local clock shows a multiple of the window. If the window is shorter than
/// the interval or not a multiple of it, the interval is used.
/// @return nothing if no block is complete.
[[nodiscard]] std::optional<PeakDemand> find_peak(const MonthSlots& month, const PeakRule& rule);

/// Validates, fills and sums one month. `received` is the month as it arrived: measured values,
/// `ok`, `missing` or the source's own flag. Coverage is relative to all slots of the local month,
/// so it also shows that a record starts mid-month.
[[nodiscard]] ClosedMonth close_month(std::uint32_t meter_index, MonthSlots received,
                                      const Meter& meter, const ValidationContext& context,
                                      const ClosingOptions& options);

}  // namespace recald::metering
