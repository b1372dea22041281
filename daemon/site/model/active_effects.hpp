/// The effects that were added to a site's model, as a calibration meets them.
///
/// Their parameters η were learnt from the months of the diagnosis (`months_used`), and those must
/// not teach them twice: a month after them takes the posterior of η as prior
/// and calibrates it jointly with θ; a month up to them takes η from its draws, without feedback.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/diagnosis/model_version.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// The version in force; that of the drawings where nothing was ever added.
/// @return what `models::ModelStore::active` finds: a calibration must not go on without an effect
///         only because its file is damaged.
[[nodiscard]] Result<diagnosis::ModelVersion> active_version(const SiteConfig& site);

/// Its effects, in the order of addition; none for the drawings.
[[nodiscard]] Result<std::vector<diagnosis::AddedEffect>> active_effects(const SiteConfig& site);

/// How results name the model that made them: the version in force, or `drawings` where it is the
/// model of the drawings.
[[nodiscard]] std::string version_name(const diagnosis::ModelVersion& active,
                                       const std::string& drawings);

/// Whether the month may teach the effect's parameters: it lies after all that they learnt from.
[[nodiscard]] bool may_teach(const diagnosis::AddedEffect& effect, metering::Month month);

/// What an effect's parameter is called among those of a design or a calibration:
/// "night_setback_missing_share"; with its meter where it has one, "meter_scale_heat_factor".
[[nodiscard]] std::string effect_parameter_name(const diagnosis::AddedEffect& effect,
                                                const diagnosis::EffectParameterRecord& parameter);

/// A meta-model speaks only of what its design varied.
/// @return unsupported with the first effect that has a parameter which the design lacks.
[[nodiscard]] Result<void> require_in_design(std::span<const diagnosis::AddedEffect> effects,
                                             std::span<const Parameter> design);

}  // namespace recald::daemon
