/// Where the files of a calibration go.
#pragma once

#include <filesystem>
#include <string>

namespace recald::daemon {

/// `out`, unless the calibration failed its gate and `out` holds one that passed: that one is kept,
/// and the failed one goes into `out`/unconverged.
[[nodiscard]] std::filesystem::path result_folder(const std::filesystem::path& out, bool converged);

/// What to say when that happened.
[[nodiscard]] std::string kept_sentence(const std::filesystem::path& folder);

}  // namespace recald::daemon
