/// Who owns the files that we create for somebody else.
#pragma once

#include <filesystem>

namespace recald::system {

/// Gives a file the owner and the group of another file or folder, where we may: a daemon must be
/// able to open what an administrator puts in place for it. Otherwise nothing changes.
void own_like(const std::filesystem::path& file, const std::filesystem::path& other);

}  // namespace recald::system
