/// A site file for surveyed exports, each guess a comment beside its key.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "daemon/site/setup/export_survey.hpp"

namespace recald::daemon {

struct SiteDraft {
  std::string text;                    ///< TOML.
  std::vector<std::string> meter_ids;  ///< In order of exports and their meters.
  std::vector<std::string> guesses;    ///< What its owner should look at, a sentence each.
};

/// @param folder    Where the file will stand; paths of exports are relative to it.
/// @param timezone  IANA name, and why.
[[nodiscard]] SiteDraft draft_site(std::span<const SurveyedExport> exports,
                                   const std::filesystem::path& folder,
                                   const Guess<std::string>& timezone);

}  // namespace recald::daemon
