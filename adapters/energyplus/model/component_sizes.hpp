/// Sizes that EnergyPlus has worked out for autosized equipment, written into the model, so that a
/// change of the building does not also change its plant.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "adapters/energyplus/model/model_document.hpp"
#include "core/result.hpp"

namespace recald::energyplus {

/// A row of the table ComponentSizes.
struct ComponentSize {
  std::string type;         ///< "AirTerminal:SingleDuct:VAV:Reheat"
  std::string name;         ///< In capital letters.
  std::string description;  ///< "Design Size Maximum Air Flow Rate"
  double value;
};

/// @return as `read_meters`.
[[nodiscard]] Result<std::vector<ComponentSize>> read_component_sizes(
    const std::filesystem::path& file);

struct FrozenSizes {
  int frozen = 0;
  std::vector<std::string> left;  ///< "Type/Name/field", still autosized.
};

/// Gives autosized fields their design sizes. Those of cooling towers stay: EnergyPlus sizes a
/// tower's parts against each other, and refuses a mixture.
FrozenSizes freeze_sizes(const std::vector<ComponentSize>& sizes, Json& objects);

}  // namespace recald::energyplus
