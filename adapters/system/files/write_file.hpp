/// Writes files completely or not at all.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/result.hpp"

namespace recald::system {

/// Writes beside the target, flushes, then renames over it: a crash leaves the old file or none.
/// @return io_failed with the path and the system's reason.
[[nodiscard]] Result<void> write_file(const std::filesystem::path& file, std::string_view bytes);

/// Creates the folder and its parents. @return io_failed with the path and the reason.
[[nodiscard]] Result<void> make_folder(const std::filesystem::path& folder);

}  // namespace recald::system
