/// Runs of a site's EnergyPlus model with measures carried out.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/executor.hpp"
#include "core/result.hpp"
#include "core/savings/measure.hpp"
#include "daemon/site/calibrate/site_runs.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// Where the runs with these measures are: in the folder of the model's runs.
[[nodiscard]] std::filesystem::path measure_folder(const ModelConfig& model,
                                                   std::span<const savings::Measure> measures);

/// Whether they are there, with all that is kept of them.
/// @pre the model is of kind energyplus
[[nodiscard]] bool has_measure_runs(const ModelConfig& model,
                                    std::span<const savings::Measure> measures);

/// Repeats the first runs of the design, in its months and weather, with these measures carried out
/// after the run's own parameters. An extent that is not known is drawn anew for each run.
/// @return as `make_runs`; not_found: the design, or what a measure changes, is not there;
///         unsupported: the model has no such quantity; invalid_value: the design's runs were made
///         otherwise than they would be now.
/// @pre the site's model is of kind energyplus
[[nodiscard]] Result<MadeRuns> make_measure_runs(const ModelledSite& modelled,
                                                 std::span<const savings::Measure> measures,
                                                 const ForEachIndex& executor,
                                                 const Engine::Observer& observer);

}  // namespace recald::daemon
