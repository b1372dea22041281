/// From a month's readings to the figures that a model is judged by.
#pragma once

#include <chrono>

#include "core/metering/gap_fill.hpp"
#include "core/metering/month_slots.hpp"
#include "core/metering/monthly_figure.hpp"
#include "core/metering/validation.hpp"

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
  MonthSlots slots;  ///< Validated and filled: what the figure was made from.
};

/// Largest mean over complete blocks of the rule's window, every slot of them measured and valid.
/// Blocks start where the local clock shows a multiple of the window. A window shorter than the
/// interval or no multiple of it is the interval.
/// @return none when no block is complete.
[[nodiscard]] std::optional<PeakDemand> find_peak(const MonthSlots& month, const PeakRule& rule);

/// Validates, fills and sums one month. `received` is the month as it came: measured values, `ok`,
/// `missing` or what the source said. Coverage counts against all slots of the local month, so
/// a record that starts in its middle says so.
[[nodiscard]] ClosedMonth close_month(std::uint32_t meter_index, MonthSlots received,
                                      const Meter& meter, const ValidationContext& context,
                                      const ClosingOptions& options);

}  // namespace recald::metering
