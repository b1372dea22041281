/// From a site's files to what a diagnosis needs: drivers, meters by the hour, uncertain
/// parameters.
#pragma once

#include "core/diagnosis/site_problem.hpp"
#include "core/result.hpp"
#include "daemon/config/site_config.hpp"
#include "daemon/replay/recording.hpp"
#include "daemon/replay/site_weather.hpp"

namespace recald::daemon {

/// The site over all months of its calibration and validation that have weather.
/// @return not_enough_data  fewer than six months, no modelled meter with readings, no electricity
///                          meter, weather with holes.
[[nodiscard]] Result<diagnosis::SiteProblem> make_site_problem(
    const SiteConfig& site, const metering::LocalCalendar& calendar, const Recording& recording,
    const SiteWeather& weather);

}  // namespace recald::daemon
