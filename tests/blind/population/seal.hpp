/// Answers are hashed, and the hash is published, before anything runs on the cases; records.py
/// opens only what still has these hashes.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace recald::blind {

/// Writes `answers.sha256`: what `sha256sum *.json` prints, sorted by name, and the line
/// "# whole HASH", the SHA-256 of the lines above it, which `sha256sum --check` takes for a
/// comment.
/// @return HASH, or not_found, io_failed
[[nodiscard]] Result<std::string> seal_answers(const std::filesystem::path& folder);

}  // namespace recald::blind
