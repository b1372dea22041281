/// Where tests find data that are not made in them.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace recald::testing {

/// tests/data: made by this project's own programs, so it is always there.
inline std::filesystem::path own_data(std::string_view name) {
  return std::filesystem::path{RECALD_SOURCE_DIR} / "tests" / "data" / name;
}

/// Measured by others, who may not want them copied: RECALD_DATA, or a folder beside the project.
/// Tests that need them skip where they are absent.
inline std::filesystem::path others_data(std::string_view name) {
  const char* const folder = std::getenv("RECALD_DATA");
  return std::filesystem::path{folder != nullptr ? folder : RECALD_DATA_DEFAULT} / name;
}

}  // namespace recald::testing
