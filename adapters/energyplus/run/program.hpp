/// The EnergyPlus of this machine.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace recald::energyplus {

struct Program {
  std::filesystem::path executable;
  std::string version;  ///< "25.2", the two numbers that a model's Version object has.

  /// Beside it: the converter from IDF and what that needs.
  [[nodiscard]] std::filesystem::path folder() const { return executable.parent_path(); }
};

/// Looks at `configured`, else at RECALD_ENERGYPLUS, else along PATH, and asks for the version.
/// @param configured  The program, or the folder that it is in; empty: not configured.
/// @return not_found: where it was looked for; io_failed: it does not run;
///         unsupported: older than the oldest release that is understood.
[[nodiscard]] Result<Program> find_program(const std::filesystem::path& configured);

}  // namespace recald::energyplus
