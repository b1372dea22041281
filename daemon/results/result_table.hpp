/// The table at the end of a calibration, as text.
#pragma once

#include <string>

#include "daemon/calibrate/assessed_calibration.hpp"

namespace recald::daemon {

/// Fit before and after by meter and period, then the parameters, then the warnings.
[[nodiscard]] std::string result_table(const AssessedCalibration& result);

}  // namespace recald::daemon
