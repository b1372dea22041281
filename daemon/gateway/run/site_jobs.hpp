/// The work of the daemon's jobs: as `recald calibrate` and `recald diagnose`, on
/// the latest months.
#pragma once

#include "daemon/gateway/run/job_runner.hpp"
#include "daemon/gateway/run/weather_wait.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// Each job reads the readings, weather and model versions again on its own connection, so it may
/// run on any thread. Same readings, same bytes.
///
/// A calibration says which months' weather it lacked; a failed one does too, since the weather
/// may be the reason.
/// @param options  Of calibrations of the site's own model.
[[nodiscard]] DoJob make_site_work(SharedSite site, const CalibrateOptions& options = {});

/// Reads what the site's weather file and sensors have now, in the same way.
[[nodiscard]] CheckWeather make_weather_check(SharedSite site);

}  // namespace recald::daemon
