/// The daemon as a process: real clocks, real buses, a store on disk, signals.
#pragma once

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"
#include "daemon/config/site_config.hpp"

namespace recald::daemon {

/// Runs until it is told to end (SIGTERM or SIGINT), then commits what is on its way.
/// @return nothing, or why it could not begin or not commit at its end.
[[nodiscard]] Result<void> run_service(const SiteConfig& site,
                                       const metering::LocalCalendar& calendar);

}  // namespace recald::daemon
