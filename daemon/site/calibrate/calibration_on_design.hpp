/// A site's measured months on the meta-model of a design that was run before: a calibration
/// without a single run of the simulation.
#pragma once

#include <filesystem>

#include "daemon/site/calibrate/finished_calibration.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// The measured months of a prepared site for which the design has model inputs.
/// @return unsupported when the site measures none of the design's outputs; not_enough_data when
///         the design covers none of its months.
[[nodiscard]] Result<doe::Measurements> measurements_for(const doe::DesignFolder& design,
                                                         const PreparedSite& site);

/// As `recald calibrate --doe` does it, but with the site's own months.
/// @return the calibration, its facts those of site, readings and design; or what reading the
///         design, the site and the calibration find.
[[nodiscard]] Result<FinishedDesign> calibrate_on_metamodel(const ModelledSite& modelled,
                                                            const std::filesystem::path& design,
                                                            const calibration::RunContext& context);

}  // namespace recald::daemon
