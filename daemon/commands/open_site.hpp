/// The first steps that commands share: read the site file, replay the recording, load the weather.
#pragma once

#include "daemon/commands/console.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// @return the site, or every problem of its file.
[[nodiscard]] tl::expected<OpenSite, std::vector<std::string>> open_site(
    const std::filesystem::path& file);

/// What is said of a meter with source = "http" at a site without [http].
[[nodiscard]] std::string nowhere_to_push(const SiteConfig& site, const MeterConfig& meter);

/// "the sum of main_a and main_b, less pv"
[[nodiscard]] std::string sum_words(const MeterConfig& meter);

/// Bad lines of the files and what the meters' data show, in words on err.
void print_data_words(const Recording& recording, const Console& console);

/// Of it, lines that were refused or left out.
void print_line_words(const Recording& recording, const Console& console);

/// Reads and replays everything of a site, with a model or without; what the data show goes to err
/// in words.
/// @return the site, or the exit code after saying what is wrong.
[[nodiscard]] tl::expected<ModelledSite, int> load_aloud(OpenSite site, const Console& console,
                                                         const ChoosePeriod& choose = {});

/// The same of a file. The site has to have a model.
/// @param model   Kind of model in the place of the site file's; absent: that one.
/// @param choose  As load_modelled_site's.
/// @return the site, or the exit code after saying what is wrong.
[[nodiscard]] tl::expected<ModelledSite, int> open_modelled_site(
    const std::filesystem::path& file, const Console& console, std::optional<ModelKind> model = {},
    const ChoosePeriod& choose = {});

}  // namespace recald::daemon
