/// A site's own model run over a design of experiments, into a folder.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "adapters/doe/design_writer.hpp"
#include "core/executor.hpp"
#include "core/result.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"

namespace recald::daemon {

struct SiteDesignOptions {
  int runs = 200;
  std::uint64_t seed = 1;
  std::string fingerprint;  ///< Of site file, data and program: what a run depends on.
};

/// Daily averages and peaks of a site's months, by name of the output. NaN: not measured.
[[nodiscard]] doe::MonthlyTable measured_table(const PreparedSite& site);

/// What is to be run, and with what it is to be compared.
[[nodiscard]] doe::DesignPlan plan_design(const PreparedSite& site,
                                          const SiteDesignOptions& options);

/// Told how many runs are done; returns false to stop.
using DesignObserver = std::function<bool(int done, int total)>;

/// Runs what the folder does not have yet, and writes after every few runs, so that little is lost.
/// @return how many runs were there before, or not_finite from the model, cancelled (what was run
/// is
///         kept), or what `open_design` and writing find.
[[nodiscard]] Result<int> run_into_folder(const PreparedSite& site, const doe::DesignPlan& plan,
                                          const std::filesystem::path& folder,
                                          const ForEachIndex& executor,
                                          const DesignObserver& observer);

}  // namespace recald::daemon
