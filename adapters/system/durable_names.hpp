/// Names of files that a power cut leaves as they were given.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace recald::system {

/// A name that came or went survives a power cut once its folder is on the disk. What cannot be
/// flushed (a folder that may not be read, a file system that flushes none) is left to the system.
/// @return io_failed when the disk failed.
[[nodiscard]] Result<void> flush_folder_of(const std::filesystem::path& file);

/// The file's bytes are on the disk before it takes the name, and the name is when this returns.
/// @return io_failed with both names and what the system said; then nothing has changed.
[[nodiscard]] Result<void> rename_durably(const std::filesystem::path& from,
                                          const std::filesystem::path& to);

/// @return io_failed with the name; nothing where there is no such file.
[[nodiscard]] Result<void> remove_durably(const std::filesystem::path& file);

}  // namespace recald::system
