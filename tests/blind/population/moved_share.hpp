/// How strong an effect is as a client counts: in shares of a meter.
#pragma once

#include <span>
#include <vector>

#include "simulators/feed/recording.hpp"

namespace recald::blind {

/// Of each interval: its month, kind of day and four hours of the day, counted through the year.
[[nodiscard]] std::vector<std::size_t> blocks_of(const simulators::Recording& recording,
                                                 const metering::LocalCalendar& calendar);

/// Sum over blocks of |footprint| against the meter's sum. Within a block a thermostat that
/// switches some minutes later takes and gives back: that is no effect, and it grows with no
/// strength.
[[nodiscard]] double moved_share(const std::vector<double>& footprint_kW,
                                 const std::vector<std::size_t>& blocks, double whole_kW);

/// Sets the shares of meters to zero that count less than 2 % of what all meters count: a gas meter
/// for a few taps may double, and nobody would call that a strong effect.
void leave_out_small_meters(std::span<const double> whole_kW, std::span<double> moved_shares);

}  // namespace recald::blind
