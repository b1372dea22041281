/// Creates and removes names of files so that they survive a power cut.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace recald::system {

/// A new or removed name survives a power cut once its folder is on the disk. Anything that cannot
/// be flushed (an unreadable folder, a file system without flush) is left to the system.
/// @return io_failed when the disk failed.
[[nodiscard]] Result<void> flush_folder_of(const std::filesystem::path& file);

/// Flushes the file before it is renamed, and the name before this returns.
/// @return io_failed with both names and the system's reason; then nothing has changed.
[[nodiscard]] Result<void> rename_durably(const std::filesystem::path& from,
                                          const std::filesystem::path& to);

/// @return io_failed with the name; succeeds if there is no such file.
[[nodiscard]] Result<void> remove_durably(const std::filesystem::path& file);

}  // namespace recald::system
