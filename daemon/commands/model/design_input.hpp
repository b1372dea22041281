/// The first steps of the commands that work on a design folder.
#pragma once

#include "adapters/doe/design_folder.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/site/calibrate/design_metamodel.hpp"

namespace recald::daemon {

/// @return the design, or the exit code after saying what is wrong.
[[nodiscard]] tl::expected<doe::DesignFolder, int> open_design_folder(
    const DesignArguments& arguments, const Console& console);

[[nodiscard]] MetamodelOptions metamodel_options(const DesignArguments& arguments,
                                                 std::uint64_t seed);

/// Writes one file of results into the folder, which is made; nothing where `folder` is empty.
[[nodiscard]] Result<void> write_result(const std::filesystem::path& folder, const char* name,
                                        const std::string& text);

}  // namespace recald::daemon
