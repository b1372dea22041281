/// Registers whose rows are written only when they change: between them they stand still.
#pragma once

#include <vector>

#include "core/metering/registers/fall_run.hpp"

namespace recald::metering {

/// Adds the samples that a register logged on change leaves out at rest: the value before a gap
/// again, one usual step before the gap ends. So what came after the rest is not spread over it.
///
/// It is taken for logged on change if it says so itself: its rows hardly ever repeat a value, and
/// over nearly all of its gaps it rises by no more than in one usual step, and by much less than a
/// load that goes on. Otherwise the samples stay as they are: a gap is an outage, over which the
/// load went on.
/// @param samples  In order of time; values that are not finite are left as they are.
[[nodiscard]] std::vector<RegisterSample> with_rests(std::vector<RegisterSample> samples);

}  // namespace recald::metering
