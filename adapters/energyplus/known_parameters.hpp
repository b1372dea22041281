/// The library of parameters for models in EnergyPlus: which places of a model each of them moves.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/energyplus/targeted_parameter.hpp"
#include "core/result.hpp"

namespace recald::energyplus {

/// A parameter of the library in a model, with the prior of the library around the model's own
/// value. Its value is in the library's unit, so that it compares with the built-in models': a
/// cooling set-point in degC, people per m2. Differences move together what differs between rooms
/// and between night and day, factors what differs between objects.
struct KnownParameter : TargetedParameter {
  std::string label;  ///< For people.
  std::string group;  ///< As in Table 1 of the seed.
};

/// Makes the model ready for known parameters: schedules split by role, and defaults that a
/// parameter moves written out. The model stays the same building. Call it once, before sizes are
/// frozen or runs are made.
void prepare_for_parameters(ModelDocument& model);

/// Those of the library that this model has, in the library's order. One that would move only
/// zeros, or fields that are still autosized, is not among them.
[[nodiscard]] std::vector<KnownParameter> known_parameters(const ModelDocument& model);

/// @param prior  Instead of the library's.
/// @return not_found: no such name in the library, with the nearest; unsupported: this model has no
/// such
///         quantity; or as model::make_parameter.
[[nodiscard]] Result<KnownParameter> find_known_parameter(const ModelDocument& model,
                                                          std::string_view name,
                                                          const std::optional<Prior>& prior = {});

/// Call after all parameters are applied: keeps what two of them change possible together, as
/// EnergyPlus demands. Heating set-points stay 1 K below those of cooling (or as near as they
/// were), panes do not let through and reflect more than all, and the least outdoor air is at most
/// the most.
/// @param nominal  The model before.
void settle(const Json& nominal, Json& objects);

}  // namespace recald::energyplus
