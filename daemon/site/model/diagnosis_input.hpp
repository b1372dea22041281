/// From a site's files to what a diagnosis needs: drivers, meters by the hour, uncertain
/// parameters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/diagnosis/site_problem.hpp"
#include "core/display/warning.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/replay/recording.hpp"
#include "daemon/site/replay/site_weather.hpp"

namespace recald::daemon {

/// Whether there is enough to diagnose: six months with weather in which a modelled meter was read.
/// @return not_enough_data, saying what is missing in the first month that is not such a one.
[[nodiscard]] Result<void> require_months(const SiteConfig& site, const Recording& recording,
                                          const SiteWeather& weather);

/// What of its data a diagnosis leaves out, assumes or has little of, in words.
[[nodiscard]] display::Warnings data_warnings(const SiteConfig& site, const Recording& recording,
                                              const SiteWeather& weather);

/// The site over all months of its calibration and validation that have weather. Humidity or wind
/// that the whole record lacks is assumed; months without readings are neither held nor shown.
/// @param last_taught  Of the months that the electricity profile is read from; absent: all that
/// are
///                     not kept to be shown.
/// @return not_enough_data  fewer than six months, no modelled meter with readings, no electricity
///                          meter, weather with holes.
[[nodiscard]] Result<diagnosis::SiteProblem> make_site_problem(
    const SiteConfig& site, const metering::LocalCalendar& calendar, const Recording& recording,
    const SiteWeather& weather, std::optional<metering::Month> last_taught = {});

}  // namespace recald::daemon
