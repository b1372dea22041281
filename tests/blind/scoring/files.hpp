/// Whole files and folders, failures as sentences.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace recald::blind {

/// @return not_found or io_failed with the path.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& file);

/// Names of what is in the folder, sorted. @return not_found with the path.
[[nodiscard]] Result<std::vector<std::string>> names_in(const std::filesystem::path& folder);

}  // namespace recald::blind
