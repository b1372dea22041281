/// A followed site in the shape that its page shows.
#pragma once

#include <string>

#include "adapters/report/drift_page.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/drift/site_drift.hpp"
#include "daemon/site/model/run_facts.hpp"

namespace recald::daemon {

/// @param generated_at  As it shall stand on the page.
[[nodiscard]] report::DriftData drift_report_of(const SiteConfig& config, const SiteDrift& drift,
                                                const RunFacts& facts, std::string generated_at);

/// Writes drift.json and drift.html into a folder that may not be there yet.
/// @param json  Of drift_json.
/// @return or what could not be written.
[[nodiscard]] Result<void> write_drift(const SiteConfig& config, const SiteDrift& drift,
                                       const RunFacts& facts, std::string generated_at,
                                       const std::string& json,
                                       const std::filesystem::path& folder);

}  // namespace recald::daemon
