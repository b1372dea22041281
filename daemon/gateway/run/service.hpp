/// The daemon as a process: real clocks, real buses, a store on disk, signals, HTTP.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "core/metering/registers/trial_clock.hpp"
#include "core/result.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

struct ServiceOptions {
  std::optional<metering::TrialClock> trial;  ///< Absent: real time.
  /// A new file to which everything that comes in is written; empty: none. Whatever becomes of it,
  /// the daemon goes on.
  std::filesystem::path record;
  std::uint64_t record_max_bytes = 0;
};

/// Runs until SIGTERM or SIGINT, then commits what is pending. SIGHUP reads the
/// site file again, SIGUSR1 requests a calibration.
/// @return nothing, or why it could not start or could not commit at its end.
[[nodiscard]] Result<void> run_service(OpenSite site, const ServiceOptions& options);

}  // namespace recald::daemon
