/// What a regression of a meter's days on the outdoor temperature makes of the same months.
#pragma once

#include <optional>
#include <vector>

#include "core/assessment/given_data.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"

namespace recald::daemon {

/// Forecasts of every output by a regression of its meter's days, fitted to the calibration months.
/// @return (outputs) absent for peaks, and for a meter whose days cannot be regressed.
[[nodiscard]] std::vector<std::optional<assessment::OutputForecasts>> yardsticks_of(
    const SiteConfig& site, const metering::LocalCalendar& calendar, const Recording& recording,
    const SiteWeather& weather, const SiteCalibration& result);

}  // namespace recald::daemon
