/// A client's model file, whichever of EnergyPlus's two formats it has.
#pragma once

#include <filesystem>

#include "adapters/energyplus/model/model_document.hpp"
#include "adapters/energyplus/run/program.hpp"
#include "core/result.hpp"

namespace recald::energyplus {

/// epJSON as it is; IDF through EnergyPlus's own ExpandObjects (where it has templates) and
/// ConvertInputFormat, in a scratch folder: the client's file is never written. A model of an older
/// release of the same year is taken as one of this program's.
/// @return not_found, malformed; unsupported: a model of another year's release; io_failed: the
///         converter is not beside the program, or refuses the file, in its own words.
[[nodiscard]] Result<ModelDocument> read_model(const std::filesystem::path& file,
                                               const Program& program);

}  // namespace recald::energyplus
