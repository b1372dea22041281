/// The effects of the model version in force, in a site's EnergyPlus model.
#pragma once

#include "core/diagnosis/model_version.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// Gives the model the version's effects: their parameters come behind the model's own, with the
/// priors that the catalogue gives them, for the months that a diagnosis has read are among those
/// of a calibration. Dates stay where the diagnosis found them. Runs with effects have a design
/// folder of their own beside that of the drawings, named after the version. A version without
/// effects changes nothing.
/// @return unsupported: an effect that EnergyPlus cannot be given, with what to do.
/// @pre the model is of this kind
[[nodiscard]] Result<void> take_in_effects(const diagnosis::ModelVersion& version,
                                           ModelConfig& model);

}  // namespace recald::daemon
