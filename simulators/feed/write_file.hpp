/// Writes one file of a feed or a figure.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace recald::simulators {

/// Creates the folder and its parents. @return io_failed with the path and the reason.
[[nodiscard]] Result<void> make_folder(const std::filesystem::path& folder);

/// Replaces the file. @return io_failed with the path and the system's reason.
[[nodiscard]] Result<void> write_file(const std::filesystem::path& path, const std::string& text);

}  // namespace recald::simulators
