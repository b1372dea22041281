/// A results line of what `recald calibrate` wrote about a case.
#pragma once

#include "tests/blind/running/diagnosis_line.hpp"

namespace recald::blind {

/// For each meter the CV(RMSE) over unseen months, of mean daily energies: before and after
/// calibrating, of the forecast, and of the yardstick. A meter that lacks one of the four is left
/// out.
/// @param calibration  calibration.json, as `recald calibrate` writes it.
/// @return malformed if a key is missing.
[[nodiscard]] Result<Json> calibration_line(const Json& calibration, const CaseRun& run);

}  // namespace recald::blind
