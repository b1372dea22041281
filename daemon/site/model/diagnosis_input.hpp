/// Prepares a diagnosis from a site's files: drivers, hourly meter data, uncertain parameters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/diagnosis/evidence/site_problem.hpp"
#include "core/display/warning.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/replay/recording.hpp"
#include "daemon/site/replay/site_weather.hpp"

namespace recald::daemon {

/// Whether there are enough data to diagnose: six months with weather in which a
/// modelled meter was read.
/// @return not_enough_data, saying what the first unusable month lacks.
[[nodiscard]] Result<void> require_months(const SiteConfig& site, const Recording& recording,
                                          const SiteWeather& weather);

/// What of its data a diagnosis leaves out, assumes or has little of, in words.
[[nodiscard]] display::Warnings data_warnings(const SiteConfig& site, const Recording& recording,
                                              const SiteWeather& weather);

/// The site over all months of its calibration and validation that have weather. If the
/// whole record lacks humidity or wind, it is assumed. Months without readings are neither
/// kept back nor shown.
/// @param last_taught  Last month used for the electricity profile; absent: all months except those
///                     to be shown are used.
/// @return not_enough_data  fewer than six months, no modelled meter with readings, no electricity
///         meter, weather with holes.
[[nodiscard]] Result<diagnosis::SiteProblem> make_site_problem(
    const SiteConfig& site, const metering::LocalCalendar& calendar, const Recording& recording,
    const SiteWeather& weather, std::optional<metering::Month> last_taught = {});

}  // namespace recald::daemon
