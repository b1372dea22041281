/// A parameter of a model in EnergyPlus.
#pragma once

#include <vector>

#include "adapters/energyplus/model_document.hpp"
#include "core/model/parameter.hpp"

namespace recald::energyplus {

/// A parameter, and what it does to the model.
struct TargetedParameter {
  Parameter parameter;
  std::vector<Target> targets;
  ChangeKind change = ChangeKind::scale;
  /// The value at which the model is as it stands: of a factor 1, of a difference 0, of a quantity
  /// that is scaled or shifted to a value what the model has.
  double design = 1.0;

  /// What `apply` needs for a value of the parameter.
  [[nodiscard]] double amount(double value) const {
    if (change == ChangeKind::scale) return value / design;
    return change == ChangeKind::add ? value - design : value;
  }
};

}  // namespace recald::energyplus
