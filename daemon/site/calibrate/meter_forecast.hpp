/// Forecasts of a site that has meters and a temperature, and no model.
#pragma once

#include "core/result.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// What a regression of each meter's days on temperature says (core/change_point): the yardstick of
/// a calibration, here by itself. A meter whose days are too few has no forecast and a warning.
/// @return months, and outputs with their forecasts; no parameters and no draws.
///         not_enough_data where no calibration month has a temperature, or no meter a forecast.
/// @pre the site has a period, see `load_modelled_site`
[[nodiscard]] Result<SiteCalibration> forecast_meters(const ModelledSite& site);

}  // namespace recald::daemon
