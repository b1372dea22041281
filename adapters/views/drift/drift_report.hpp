/// A followed site in the shape that its page shows.
#pragma once

#include <filesystem>
#include <string>

#include "adapters/results/run_facts.hpp"
#include "adapters/views/drift/drift_page.hpp"
#include "core/drift/site_drift.hpp"

namespace recald::views {

/// @param generated_at  As it shall stand on the page.
[[nodiscard]] DriftData drift_report_of(const SiteLine& site, const drift::SiteDrift& drift,
                                        const RunFacts& facts, std::string generated_at);

/// Writes drift.json and drift.html into a folder that may not be there yet.
/// @param json  Of drift_json.
/// @return or what could not be written.
[[nodiscard]] Result<void> write_drift(const SiteLine& site, const drift::SiteDrift& drift,
                                       const RunFacts& facts, std::string generated_at,
                                       const std::string& json,
                                       const std::filesystem::path& folder);

}  // namespace recald::views
