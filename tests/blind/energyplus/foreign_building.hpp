/// EnergyPlus models that others wrote, altered until nobody has seen them: buildings to judge with
/// that share nothing with ours.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "core/random/rng.hpp"
#include "simulators/building/drawings.hpp"
#include "tests/blind/energyplus/engine.hpp"

namespace recald::blind {

struct ForeignModel {
  std::string_view file;
  simulators::Use like;  ///< Whose closing days it has.
};

/// Those that nothing was developed on. Their package (sinergym) is read, never copied.
[[nodiscard]] std::span<const ForeignModel> foreign_models();

/// RECALD_EXAMPLES names their folder. @return not_found, io_failed
[[nodiscard]] Result<Json> read_foreign_model(std::string_view file);

/// Another size, other insulation and glass, other densities, an hour more or less.
[[nodiscard]] Json altered(Json model, Rng rng);

}  // namespace recald::blind
