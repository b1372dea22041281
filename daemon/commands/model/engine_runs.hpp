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

/// What makes runs while an observer watches.
using MakeRuns =
    std::function<Result<MadeRuns>(const ForEachIndex& executor, const Engine::Observer& observer)>;

/// Shows progress and time left while runs are made; failures as above.
[[nodiscard]] tl::expected<MadeRuns, int> make_runs_aloud(const MakeRuns& make, unsigned threads,
                                                          const Console& console);

/// A site that has all runs which its EnergyPlus model needs, after making those that are missing;
/// a site with another model is as it is.
/// @param open  Opens the site; again where runs were made, since they are part of what a result
///              depends on.
[[nodiscard]] tl::expected<ModelledSite, int> with_runs(
    const std::function<tl::expected<ModelledSite, int>(const Console&)>& open, std::uint64_t seed,
    unsigned threads, const Console& console);

}  // namespace recald::daemon
