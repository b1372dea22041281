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

/// Of the design's runs, those that are repeated with a measure. What it saves depends on the
/// parameters less than the use does, so fewer are needed.
inline constexpr int kMeasureRuns = 60;

/// The changes of these measures, one after the other.
[[nodiscard]] std::vector<savings::Change> changes_of(std::span<const savings::Measure> measures);

/// Those whose extent is not known: columns of the design, behind the parameters.
[[nodiscard]] std::vector<savings::Change> uncertain(std::vector<savings::Change> changes);

/// Each measure by itself and, where there are several, all of them.
[[nodiscard]] std::vector<std::span<const savings::Measure>> alone_and_together(
    const std::vector<savings::Measure>& measures);

/// Where the runs with these measures are: in the folder of the model's runs.
[[nodiscard]] std::filesystem::path measure_folder(const ModelConfig& model,
                                                   std::span<const savings::Measure> measures);

/// @pre the model is of kind energyplus
[[nodiscard]] bool has_measure_runs(const ModelConfig& model,
                                    std::span<const savings::Measure> measures);

/// Repeats the first of the design's runs, in its months and weather, with these measures carried
/// out behind the run's own parameters. An extent that is not known is drawn anew for each run.
/// @return as `make_runs`; not_found: the design is not there, or a target is not in the model.
/// @pre the site's model is of kind energyplus
[[nodiscard]] Result<MadeRuns> make_measure_runs(const ModelledSite& modelled,
                                                 std::span<const savings::Measure> measures,
                                                 const ForEachIndex& executor,
                                                 const Engine::Observer& observer);

}  // namespace recald::daemon
