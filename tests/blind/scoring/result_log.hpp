/// Results files: JSON lines, one a case and method, appended as cases are done.
///
/// A line counts once its line feed is written. What follows the last line feed is a line that a
/// power cut tore: readers report and ignore it, `append_result` cuts it off.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "tests/blind/scoring/case_result.hpp"

namespace recald::blind {

/// What to do with a second line of the same case and method.
enum class Reruns {
  refuse,   ///< An error that names both lines.
  replace,  ///< The later one counts; how many were replaced is reported.
};

struct ResultLog {
  std::vector<CaseResult> results;  ///< In the order of the lines.
  std::vector<std::string> torn;    ///< A sentence for each torn last line.
  int replaced = 0;                 ///< Lines that a later one replaced.
  std::string hash;                 ///< SHA-256 of the whole lines read.
};

/// @param name  Of the file, for messages.
/// @return malformed with the line's number; invalid_value for a rerun that is refused.
[[nodiscard]] Result<ResultLog> parse_results(std::string_view text, const std::string& name,
                                              Reruns reruns);

/// Reads several files as one. @return not_found, io_failed, or as `parse_results`.
[[nodiscard]] Result<ResultLog> read_results(std::span<const std::filesystem::path> files,
                                             Reruns reruns);

/// Checks the line, cuts a torn tail off the file, appends the line and waits for the disk. The
/// file is locked meanwhile, so several runners may append to it. Makes the file if absent.
/// @return malformed, invalid_value for a rerun that is refused, io_failed.
[[nodiscard]] Result<void> append_result(const std::filesystem::path& file, std::string_view line,
                                         Reruns reruns);

/// Cases of the population, sorted. A case is a folder in `population` that holds a `site.toml`.
/// @return not_found if there is none.
[[nodiscard]] Result<std::vector<std::string>> cases_in(const std::filesystem::path& population);

struct PendingCases {
  std::vector<std::string> cases;
  std::vector<std::string> torn;  ///< A sentence for a torn last line.
};

/// Cases of the population without a line of `method`, sorted. A results file that does not exist
/// yet holds no line.
/// @return not_found if the population has no case; else as `read_results`.
[[nodiscard]] Result<PendingCases> pending_cases(const std::filesystem::path& population,
                                                 const std::filesystem::path& results,
                                                 const std::string& method);

}  // namespace recald::blind
