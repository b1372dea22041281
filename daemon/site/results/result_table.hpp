/// The table at the end of a calibration, as text.
#pragma once

#include <string>

#include "core/assessment/assessed_calibration.hpp"

namespace recald::daemon {

/// Fit before and after by meter and period, then the parameters, then the warnings.
[[nodiscard]] std::string result_table(const assessment::AssessedCalibration& result);

/// Of a site without a model: forecasts alone.
[[nodiscard]] std::string meter_forecast_table(const assessment::AssessedCalibration& result);

}  // namespace recald::daemon
