/// One calibration of a site, or of a design of experiments, as commands and the daemon do it: all
/// that its files are made from.
#pragma once

#include <string>

#include "core/calibration/calibration.hpp"
#include "daemon/site/calibrate/design_calibration.hpp"
#include "daemon/site/calibrate/design_origin.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// Everything that a calibration leaves behind.
struct FinishedCalibration {
  ModelledSite modelled;  ///< Its facts with what the sampling took, but without the wall time.
  SiteCalibration calibration;
};

struct FinishedDesign {
  std::string name;  ///< Of the building: the folder's, or the site's.
  doe::DesignFolder design;
  DesignCalibration calibration;
  RunFacts facts;
};

/// With the effects of the version in force. @return or the errors of `calibrate_site`.
[[nodiscard]] Result<FinishedCalibration> finish_calibration(
    ModelledSite modelled, const CalibrateOptions& options, const calibration::RunContext& context);

/// A design whose months were measured. `done` comes with all but the calibration.
/// @param origin  What it must not teach is held, and said.
/// @return or the errors of `calibrate_design`
[[nodiscard]] Result<FinishedDesign> finish_calibration(FinishedDesign done,
                                                        const DesignOrigin& origin,
                                                        const doe::Measurements& measured,
                                                        DesignCalibrationOptions options,
                                                        const calibration::RunContext& context);

}  // namespace recald::daemon
