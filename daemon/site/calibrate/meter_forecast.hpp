/// Forecasts of a site whose model cannot be calibrated, or that has none: meters and a temperature
/// are enough.
#pragma once

#include <string>

#include "core/result.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"

namespace recald::daemon {

/// What a regression of each meter's days on temperature says (core/change_point): the yardstick of
/// a calibration, here by itself. A meter whose days are too few has no forecast and a warning.
/// @param because  Why no model was calibrated, as a sentence.
/// @return months, and outputs with their forecasts; no parameters and no draws.
///         not_enough_data where no calibration month has a temperature, or no meter a forecast.
/// @pre the site has a period, see `load_modelled_site`
[[nodiscard]] Result<SiteCalibration> forecast_meters(const SiteConfig& site,
                                                      const metering::LocalCalendar& calendar,
                                                      const Recording& recording,
                                                      const SiteWeather& weather,
                                                      std::string because);

}  // namespace recald::daemon
