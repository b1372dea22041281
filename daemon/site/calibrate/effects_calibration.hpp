/// Calibrating a site whose model has effects that a diagnosis added.
///
/// What a diagnosis learnt of an effect's parameters η it learnt from months, and those must not
/// teach η twice. All calibration months later than the diagnosis: η is
/// calibrated with θ, its posterior as prior. None later: θ is drawn given each of 50 draws of η,
/// without feedback. Some later: these alone move η first, and the cut goes on from there.
#pragma once

#include "core/calibration/calibration.hpp"
#include "core/result.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"

namespace recald::daemon {

/// Fills `result.calibration`; parameters are θ, then η. How η was treated is put into
/// `result.warnings`, and so is what was found.
///
/// In a cut, findings, evidence and leave-out scores are of η at its mean; draws, summaries and
/// convergence are of the pooled draws, at which no η is judged: it does not move.
/// @param prepared  With effects; its problem loses outputs that nothing but an effect moves.
/// @param design    Of θ and η.
[[nodiscard]] Result<void> calibrate_with_effects(PreparedSite& prepared,
                                                  const CalibrateOptions& options,
                                                  calibration::DesignRuns design,
                                                  const calibration::RunContext& context,
                                                  SiteCalibration& result);

}  // namespace recald::daemon
