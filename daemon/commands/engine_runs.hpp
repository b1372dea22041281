/// Runs of a site's EnergyPlus model, with progress and the time that they take.
#pragma once

#include <tl/expected.hpp>

#include "daemon/commands/console.hpp"
#include "daemon/site/calibrate/site_runs.hpp"

namespace recald::daemon {

/// Failures are printed and come back as an exit code. Ctrl-C stops; what was run is kept.
[[nodiscard]] tl::expected<MadeRuns, int> make_runs_aloud(const ModelledSite& modelled,
                                                          const RunsOptions& options,
                                                          unsigned threads, const Console& console);

}  // namespace recald::daemon
