/// The bytes of a file.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace recald::system {

/// @return io_failed with the path and the reason.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& file);

}  // namespace recald::system
