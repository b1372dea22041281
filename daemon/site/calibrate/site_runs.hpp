/// The runs of a site's EnergyPlus model: planned, made where they are missing, kept in its folder.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "adapters/doe/design_writer.hpp"
#include "adapters/energyplus/energyplus_engine.hpp"
#include "adapters/ports/engine.hpp"
#include "adapters/system/files/file_lock.hpp"
#include "core/design/latin_hypercube.hpp"
#include "core/executor.hpp"
#include "core/result.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// In the design's folder: the weather that its runs had, hourly means.
inline constexpr const char* kRunsWeather = "weather.csv";
/// Likewise: YEAR.epw, as EnergyPlus had it.
inline constexpr const char* kWeatherYears = "weather";

struct RunsOptions {
  std::filesystem::path folder;  ///< Empty: the model's own.
  int runs = 0;                  ///< 0: as the site file says.
  std::uint64_t seed = 1;
  design::Points points = design::Points::wide;
};

struct MadeRuns {
  std::vector<std::string> parameters;
  std::vector<std::string> outputs;
  std::size_t months = 0;
  int total = 0;
  int before = 0;                  ///< That were there already.
  int failed = 0;                  ///< They are named in failed.csv, and tried again next time.
  std::vector<std::string> notes;  ///< In words.
};

/// Only one process at a time makes runs in a folder.
/// @return unsupported: another does.
[[nodiscard]] Result<system::FileLock> lock_runs(const std::filesystem::path& folder);

/// Runs what is missing of a plan.
/// @param run_by     Runs the plan's rows on `engine`, or is it.
/// @param with_days  Keeps the days of the runs too, which months that were not simulated are
///                   predicted from.
/// @return or invalid_value: every run failed, with EnergyPlus's words; cancelled: what was run is
///         kept; as `FolderEngine`.
[[nodiscard]] Result<MadeRuns> make_planned_runs(const std::filesystem::path& folder,
                                                 const doe::DesignPlan& plan, Engine& run_by,
                                                 const energyplus::EnergyPlusEngine& engine,
                                                 bool with_days, const ForEachIndex& executor,
                                                 const Engine::Observer& observer);

/// Whether the runs in the site's design are of the model as the site file has it now: the same
/// fields changed in the same way, the same reports of its outputs, and, where the model file is at
/// hand, the same bytes. Nothing is said against a folder that does not tell.
/// @return invalid_value: what was edited since. @pre the model is of kind energyplus
[[nodiscard]] Result<void> require_runs_of(const ModelConfig& model);

/// Whether every run of the site's design is there, or is known to fail: then nothing is to be
/// made.
/// @pre the site's model is of kind energyplus
[[nodiscard]] bool has_all_runs(const SiteConfig& site);

/// Runs what is missing of a design over the site's months. Only one process at a time
/// works in a folder.
/// @param observer  As `Engine::Observer`.
/// @return or the errors of `make_energyplus_engine`; unsupported: another process runs there;
///         invalid_value: the folder has another design, or every run failed, with EnergyPlus's
///         words; cancelled: what was run is kept.
/// @pre the site's model is of kind energyplus
[[nodiscard]] Result<MadeRuns> make_runs(const ModelledSite& modelled, const RunsOptions& options,
                                         const ForEachIndex& executor,
                                         const std::function<bool(int, int)>& observer);

}  // namespace recald::daemon
