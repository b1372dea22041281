/// Which paths can be read as files, and who may read the files we create.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string_view>

#include "core/result.hpp"

namespace recald::system {

/// For files with readings of a building: the owner reads and writes, the group reads. A stricter
/// umask removes more.
inline constexpr mode_t kPrivateMode = 0640;

/// Creates an empty file with kPrivateMode if there is none, before a library creates it with other
/// rights. On failure, the library will fail and report it.
void make_private_file(const std::filesystem::path& file);

/// Whether a path names a file that can be read to its end. A pipe without a writer would block the
/// reader forever, and a device may have no end.
/// @param what  What people call it: "readings file".
/// @return not_found, or io_failed for a folder, a pipe, a socket or a device.
[[nodiscard]] Result<void> require_file(const std::filesystem::path& file, std::string_view what);

}  // namespace recald::system
