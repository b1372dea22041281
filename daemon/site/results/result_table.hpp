/// The table at the end of a calibration, as text.
#pragma once

#include <string>

#include "core/assessment/assessed_calibration.hpp"

namespace recald::daemon {

/// Fit before and after by meter and period, then the parameters, then the warnings. Where no model
/// was calibrated: why, forecasts, warnings.
[[nodiscard]] std::string result_table(const assessment::AssessedCalibration& result);

}  // namespace recald::daemon
