/// The effects that were added to a site's model, as a calibration uses them.
///
/// Their parameters η were learnt from the months of the diagnosis (`months_used`), and no month
/// may be used twice. For a later month, the posterior of η is the prior, and η is calibrated
/// jointly with θ. For a month up to them, η is taken from its draws, without feedback.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/diagnosis/model_version.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// The version in force, or the drawings if nothing was ever added.
/// @return the version, or as `models::ModelStore::active`: a calibration must not continue without
///         an effect because its file is damaged.
[[nodiscard]] Result<diagnosis::ModelVersion> active_version(const SiteConfig& site);

/// The effects of the version in force, in the order of addition; none for the drawings.
[[nodiscard]] Result<std::vector<diagnosis::AddedEffect>> active_effects(const SiteConfig& site);

/// How results name the model that they come from: the version in force, or `drawings` for the
/// model of the drawings.
[[nodiscard]] std::string version_name(const diagnosis::ModelVersion& active,
                                       const std::string& drawings);

/// A meta-model only knows the parameters that its design varied.
/// @return unsupported for the first effect with a parameter that the design lacks.
[[nodiscard]] Result<void> require_in_design(std::span<const diagnosis::AddedEffect> effects,
                                             std::span<const Parameter> design);

}  // namespace recald::daemon
