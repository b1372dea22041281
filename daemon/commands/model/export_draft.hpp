/// Exports of meters on the way to a site: what `recald init` writes and `recald report` reads.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "daemon/commands/console.hpp"
#include "daemon/site/setup/site_file.hpp"

namespace recald::daemon {

struct ExportDraft {
  std::vector<SurveyedExport> exports;
  Guess<std::string> timezone;
  metering::LocalCalendar calendar;  ///< Of that zone.
  SiteDraft draft;
  SurveyHints hints;  ///< As given, and as answered.
};

/// What no evidence settles is asked of whoever is at the console; where nobody is, it is refused
/// with the option that answers it.
/// @param timezone  IANA name, or empty.
/// @param hints     What is known of the files.
/// @param folder    Where the site file will stand.
/// @return the draft, or the exit code after saying what is wrong.
[[nodiscard]] tl::expected<ExportDraft, int> draft_aloud(
    const std::vector<std::filesystem::path>& files, const std::string& timezone, SurveyHints hints,
    const std::filesystem::path& folder, const Console& console);

/// A line a meter, then what its owner should look at.
/// @param look     Says so.
/// @param area_m2  Floor area; absent: not known.
void print_draft(const ExportDraft& drafted, std::string_view look, std::optional<double> area_m2,
                 const Console& console);

[[nodiscard]] nlohmann::ordered_json meters_json(const ExportDraft& drafted);

/// As options of a command line, each with a blank before it.
[[nodiscard]] std::string hint_words(const SurveyHints& hints);

/// The path as a word of a command line.
[[nodiscard]] std::string shell_word(const std::filesystem::path& path);

}  // namespace recald::daemon
