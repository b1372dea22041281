/// Commit and reveal: answers are hashed and the hash is published before anything runs on the
/// cases; the scorer opens only what still has these hashes, and every opening leaves a record.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace recald::blind {

/// `answers.sha256`: what `sha256sum` prints for the answer files, sorted by name, and the line
/// "# whole HASH", the SHA-256 of the lines above it. HASH alone is worth publishing.
/// `sha256sum --check answers.sha256` takes the last line for a comment.
/// @return HASH, or invalid_value if the folder is sealed already.
[[nodiscard]] Result<std::string> seal_answers(const std::filesystem::path& folder);

/// Compares every answer file with `answers.sha256`, and its last line with the lines above.
/// @param published  The hash published before the runs, if the caller knows it.
/// @return HASH, or
///         not_found      no seal, or an answer of it is absent;
///         malformed      a line of the seal that cannot be read;
///         invalid_value  an answer, the seal or the published hash differs, or an answer is not
///                        in the seal.
[[nodiscard]] Result<std::string> verify_seal(const std::filesystem::path& folder,
                                              const std::optional<std::string>& published);

/// One opening of the answers.
struct Opening {
  std::chrono::sys_seconds at;
  std::string scorer_version;
  std::string whole_hash;                       ///< Of the seal.
  std::string results_hash;                     ///< SHA-256 of the result lines used.
  std::map<std::string, int> cases_of_version;  ///< "recald 0.2.0" -> cases scored.
};

/// When the answers were opened before, oldest first, in UTC: "2026-11-21T10:00:00Z".
/// @return malformed if `opened.json` is there but cannot be read.
[[nodiscard]] Result<std::vector<std::string>> earlier_openings(
    const std::filesystem::path& folder);

/// Adds to `opened.json` beside the answers. @return io_failed, malformed.
[[nodiscard]] Result<void> record_opening(const std::filesystem::path& folder,
                                          const Opening& opening);

/// SHA-256 as 64 hex digits.
[[nodiscard]] std::string hash_of(std::string_view bytes);

}  // namespace recald::blind
