/// A first, short run of a model: whether it runs, what it reports, how large its plant is.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "adapters/energyplus/model/component_sizes.hpp"
#include "adapters/energyplus/model/model_document.hpp"
#include "adapters/energyplus/run/program.hpp"
#include "adapters/energyplus/run/simulation.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::energyplus {

struct TriedModel {
  ModelDocument model;  ///< With the sizes that EnergyPlus worked out.
  FrozenSizes sizes;
};

/// Runs one day, asks for the meters that the outputs need, and freezes the sizes of autosized
/// equipment. The outcome is kept in the folder, so that the same model is tried once.
/// @param weather  An EPW file that covers the day.
/// @param folder   Of the engine's runs; made where it is not there.
/// @return as `simulate` and `read_meters`; io_failed: the folder cannot be written.
[[nodiscard]] Result<TriedModel> try_model(const ModelDocument& model,
                                           const std::vector<std::string>& meters,
                                           metering::Day day, const std::filesystem::path& weather,
                                           const std::filesystem::path& folder,
                                           const Program& program, const RunLimits& limits,
                                           const std::function<bool()>& keep_going);

}  // namespace recald::energyplus
