/// Where the files of a calibration go.
#pragma once

#include <filesystem>
#include <string>

namespace recald::daemon {

/// `out`; but `out`/unconverged for a calibration that failed its gate, so that what stands in
/// `out` is kept. Only who asked for a number of draws, and has no good result there to lose, gets
/// a failed one into `out` itself.
[[nodiscard]] std::filesystem::path result_folder(const std::filesystem::path& out, bool converged,
                                                  bool draws_given);

/// Removes what an earlier calibration left: its chains may have been more, its model another.
/// calibration.json goes first, so that an interruption leaves no result rather than half of two.
void clear_results(const std::filesystem::path& folder);

/// What to say when that happened.
[[nodiscard]] std::string kept_sentence(const std::filesystem::path& folder);

}  // namespace recald::daemon
