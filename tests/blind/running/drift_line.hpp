/// A results line of what `recald drift` wrote about a case.
#pragma once

#include "tests/blind/running/diagnosis_line.hpp"

namespace recald::blind {

/// Each alarm with its likeliest cause, and which months were watched. A meter whose figures have
/// another unit, or that lost its readings, is an alarm that blames the meter.
/// @param drift  drift.json, as `recald drift` writes it.
/// @return malformed if a key is missing.
[[nodiscard]] Result<Json> drift_line(const Json& drift, const CaseRun& run);

}  // namespace recald::blind
