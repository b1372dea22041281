/// What the daemon's jobs do: what `recald calibrate` and `recald diagnose` do, on the latest
/// months.
#pragma once

#include "daemon/gateway/run/job_runner.hpp"
#include "daemon/gateway/run/weather_wait.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// Readings, weather and versions of the model are read afresh by each job, from a connection of
/// its own, so that it may run on any thread. Same readings, same bytes.
///
/// A calibration says which months' weather it lacked; one that fails says so as well, since the
/// weather may be the reason.
[[nodiscard]] DoJob make_site_work(OpenSite site);

/// What the site's weather file and sensors have now, read likewise.
[[nodiscard]] LookAtWeather make_weather_look(OpenSite site);

}  // namespace recald::daemon
