/// Finds out which programs have a file open. Two programs on one serial line garble each other's
/// frames, and the system does not stop them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace recald::system {

struct FileHolder {
  int process;
  std::string name;  ///< Of its program, cut by the system to 15 characters.
};

/// Other processes with the file or device open, according to /proc. It shows processes of other
/// users only to root, so an empty answer proves nothing.
[[nodiscard]] std::vector<FileHolder> holders_of(const std::filesystem::path& file);

}  // namespace recald::system
