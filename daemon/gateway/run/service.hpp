/// The daemon as a process: real clocks, real buses, a store on disk, signals, HTTP.
#pragma once

#include <optional>

#include "core/metering/registers/trial_clock.hpp"
#include "core/result.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

struct ServiceOptions {
  std::optional<metering::TrialClock> trial;  ///< Absent: real time.
};

/// Runs until SIGTERM or SIGINT, then commits what is pending. SIGHUP reads the
/// site file again, SIGUSR1 requests a calibration.
/// @return nothing, or why it could not start or could not commit at its end.
[[nodiscard]] Result<void> run_service(OpenSite site, const ServiceOptions& options);

}  // namespace recald::daemon
