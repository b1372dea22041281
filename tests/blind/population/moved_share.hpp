/// How strong an effect is as a client counts: in shares of a meter.
#pragma once

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

}  // namespace recald::blind
