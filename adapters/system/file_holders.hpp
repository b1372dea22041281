/// Who has a file open: two programs on one serial line garble each other's frames, and nothing
/// keeps them from opening it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace recald::system {

struct FileHolder {
  int process;
  std::string name;  ///< Of its program, as the system has it: 15 characters.
};

/// Other processes with the file or device open, as /proc shows them: those of other users only to
/// root, so an empty answer is no proof.
[[nodiscard]] std::vector<FileHolder> holders_of(const std::filesystem::path& file);

}  // namespace recald::system
