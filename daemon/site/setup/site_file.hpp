/// A site file for surveyed exports, each guess a comment beside its key.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/site/setup/export_survey.hpp"

namespace recald::daemon {

/// In double quotes, as TOML takes it.
[[nodiscard]] std::string toml_text(std::string_view text);

/// Of a site file's folder, where the file is not far from it; otherwise absolute.
[[nodiscard]] std::string relative_path(const std::filesystem::path& file,
                                        const std::filesystem::path& folder);

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
