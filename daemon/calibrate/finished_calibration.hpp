/// One calibration of a site from its readings to its files, as the command and the daemon do it.
#pragma once

#include <filesystem>
#include <string>

#include "core/calibration/calibration.hpp"
#include "daemon/calibrate/modelled_site.hpp"
#include "daemon/calibrate/site_calibration.hpp"

namespace recald::daemon {

/// Everything that a calibration leaves behind.
struct FinishedCalibration {
  ModelledSite modelled;  ///< Its facts with what the sampling took, but without the wall time.
  SiteCalibration calibration;
};

/// With the effects of the version in force. @return or the errors of `calibrate_site`.
[[nodiscard]] Result<FinishedCalibration> finish_calibration(
    ModelledSite modelled, const CalibrateOptions& options, const calibration::RunContext& context);

/// The report page. @param generated_at  Shown on it.
[[nodiscard]] std::string render(const FinishedCalibration& done, const std::string& generated_at);

/// Draws, months, profile, page and, last, calibration.json: who finds that finds everything it
/// speaks of. What an earlier calibration left in the folder goes.
[[nodiscard]] Result<void> write_calibration(const FinishedCalibration& done,
                                             const std::string& json,
                                             const std::string& generated_at,
                                             const std::filesystem::path& folder);

}  // namespace recald::daemon
