/// The one moment at which answers and results meet.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "tests/blind/scoring/result_log.hpp"
#include "tests/blind/scoring/scores.hpp"

namespace recald::blind {

struct OpenRequest {
  std::filesystem::path answers;               ///< Folder with `<case>.json` and their seal.
  std::vector<std::filesystem::path> results;  ///< Read as one.
  std::filesystem::path out;                   ///< scores.json; the page goes beside it, as .md.
  std::optional<std::filesystem::path>
      classes;                           ///< {"effect": "class"} for effects hidden nowhere.
  std::optional<std::string> published;  ///< The hash published before the runs.
  bool partial = false;                  ///< Score although cases are missing.
  Reruns reruns = Reruns::refuse;
  ScoringOptions options;
  std::chrono::sys_seconds now;  ///< Goes into opened.json and nowhere else.
  std::string scorer_version;
};

/// Verifies the seal, reads, refuses what cannot be scored, records the opening beside the answers
/// and then writes the scores. What is refused leaves no record and tells nothing of the answers.
/// @return A line or more for the console, or an error of the parts; invalid_value when cases are
///         missing and `partial` was not asked for.
[[nodiscard]] Result<std::string> open_answers(const OpenRequest& request);

/// Classes of a file `{"effect": "class"}`; none without a file. @return malformed, io_failed
[[nodiscard]] Result<EffectClasses> read_classes(const std::optional<std::filesystem::path>& file);

}  // namespace recald::blind
