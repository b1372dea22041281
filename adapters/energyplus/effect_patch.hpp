/// Effects of the catalogue as changes of an EnergyPlus model.
///
/// A patch says what an effect is to EnergyPlus: a schedule that runs on, air that is let in, a
/// load that nobody listed. Its parameters are those of the catalogue, by their names and in their
/// units, so that what a diagnosis has found of them holds for the model. What EnergyPlus cannot be
/// told (a meter that counts wrongly) has no patch.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/energyplus/model/model_document.hpp"
#include "core/result.hpp"

namespace recald::energyplus {

struct EffectPatch {
  std::string effect;  ///< Id in the catalogue.
  /// Changes the objects of such a model. @param values  In order of `parameters`.
  std::function<void(std::span<const double> values, Json& objects)> apply;
};

/// The ids of effects that some model can have, in order.
[[nodiscard]] std::vector<std::string_view> patched_effects();

/// @param parameters  Names of the effect's parameters, in the order in which their values come.
/// @return unsupported: the effect has no patch, or lacks a parameter that its patch needs, or this
///         model has nothing that it would change.
[[nodiscard]] Result<EffectPatch> find_effect_patch(const ModelDocument& model,
                                                    std::string_view effect,
                                                    std::span<const std::string> parameters);

}  // namespace recald::energyplus
