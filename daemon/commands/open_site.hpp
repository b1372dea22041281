/// The first steps that commands share: read the site file, replay the recording, load the weather.
#pragma once

#include "core/metering/civil_time.hpp"
#include "daemon/commands/console.hpp"
#include "daemon/config/site_config.hpp"
#include "daemon/replay/recording.hpp"
#include "daemon/replay/site_weather.hpp"
#include "daemon/results/run_facts.hpp"

namespace recald::daemon {

struct OpenSite {
  SiteConfig config;
  metering::LocalCalendar calendar;
};

/// @return the site, or every problem of its file.
[[nodiscard]] tl::expected<OpenSite, std::vector<std::string>> open_site(
    const std::filesystem::path& file);

/// Bad lines of the files and what the meters' data show, in words on err.
void print_data_words(const Recording& recording, const Console& console);

/// First calibration month to last validation month. @pre site.period
[[nodiscard]] metering::MonthRange whole_period(const SiteConfig& site);

/// Whether the site can be modelled at all; the sentence says what is missing.
[[nodiscard]] Result<void> require_model(const SiteConfig& site);

/// All that a model of the site is made from.
struct ModelledSite {
  OpenSite site;
  Recording recording;
  SiteWeather weather;
  RunFacts facts;
};

/// Reads and replays everything; what the data show goes to err in words.
/// @param model  Kind of model in the place of the site file's; empty: that one.
/// @return the site, or the exit code after saying what is wrong.
[[nodiscard]] tl::expected<ModelledSite, int> open_modelled_site(const std::filesystem::path& file,
                                                                 const Console& console,
                                                                 const std::string& model = "");

}  // namespace recald::daemon
