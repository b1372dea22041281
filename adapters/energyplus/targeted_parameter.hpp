/// A parameter of a model in EnergyPlus.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "adapters/energyplus/effect_patch.hpp"
#include "adapters/energyplus/model/model_document.hpp"
#include "core/metering/civil_time.hpp"
#include "core/model/parameter.hpp"

namespace recald::energyplus {

/// An effect in a model, maybe for a time.
struct ModelEffect {
  EffectPatch patch;
  std::size_t values;                 ///< How many it has.
  std::optional<metering::Day> from;  ///< First day with it; absent: from the beginning.
  std::optional<metering::Day> to;    ///< First day without it again; absent: to the end.
};

/// A parameter, and what it does to the model.
struct TargetedParameter {
  Parameter parameter;
  std::vector<Target> targets;
  ChangeKind change = ChangeKind::scale;
  /// The value at which the model is as it stands: of a factor 1, of a difference 0, of a quantity
  /// that is scaled or shifted to a value what the model has.
  double design = 1.0;
  /// Of which this is one value: those of one effect stand together, in their order.
  std::shared_ptr<const ModelEffect> effect = {};

  /// What `apply` needs for a value of the parameter.
  [[nodiscard]] double amount(double value) const {
    if (change == ChangeKind::scale) return value / design;
    return change == ChangeKind::add ? value - design : value;
  }
};

}  // namespace recald::energyplus
