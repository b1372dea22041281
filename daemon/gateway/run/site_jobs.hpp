/// What the daemon's jobs do: what `recald calibrate` and `recald diagnose` do, on the latest
/// months.
#pragma once

#include "daemon/gateway/run/job_runner.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// Readings, weather and versions of the model are read afresh by each job, from a connection of
/// its own, so that it may run on any thread. Same readings, same bytes.
[[nodiscard]] DoJob make_site_work(OpenSite site);

}  // namespace recald::daemon
