/// The runs of a design that failed, and why: failed.csv, `run,because`. No file: none did.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/result.hpp"

namespace recald::doe {

/// By number of the run. @return malformed, io_failed
[[nodiscard]] Result<std::map<int, std::string>> read_failed_runs(
    const std::filesystem::path& folder);

/// Removes the file where no run failed.
[[nodiscard]] Result<void> write_failed_runs(const std::filesystem::path& folder,
                                             const std::map<int, std::string>& failed);

}  // namespace recald::doe
