/// What may be read as a file, and who may read what is made.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string_view>

#include "core/result.hpp"

namespace recald::system {

/// Files with readings of a building: read and written by the owner, read by the group. A stricter
/// umask takes more away.
inline constexpr mode_t kPrivateMode = 0640;

/// Makes an empty file with kPrivateMode where there is none, before a library makes it with its
/// own. A failure is left for the library to meet and to name.
void make_private_file(const std::filesystem::path& file);

/// Whether a path names a file that can be read to its end. A pipe that nobody writes to would keep
/// a reader waiting for ever, and a device may have no end.
/// @param what  As people call it: "readings file".
/// @return not_found, or io_failed for a folder, a pipe, a socket or a device.
[[nodiscard]] Result<void> require_file(const std::filesystem::path& file, std::string_view what);

}  // namespace recald::system
