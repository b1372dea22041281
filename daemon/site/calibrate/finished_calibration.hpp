/// One calibration of a site from its readings to its files, as the command and the daemon do it.
#pragma once

#include <filesystem>
#include <string>

#include "core/calibration/calibration.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// Everything that a calibration leaves behind.
struct FinishedCalibration {
  ModelledSite modelled;  ///< Its facts with what the sampling took, but without the wall time.
  SiteCalibration calibration;
};

/// With the effects of the version in force. @return or the errors of `calibrate_site`.
[[nodiscard]] Result<FinishedCalibration> finish_calibration(
    ModelledSite modelled, const CalibrateOptions& options, const calibration::RunContext& context);

}  // namespace recald::daemon
