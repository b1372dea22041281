/// drift.json: what the daemon keeps and serves of a followed site.
#pragma once

#include <string>

#include "adapters/results/run_facts.hpp"
#include "core/drift/site_drift.hpp"

namespace recald::views {

/// Ends with a line feed; the same bytes for the same site, readings and seed, but for `wall_s`.
[[nodiscard]] std::string drift_json(const drift::SiteDrift& drift, const RunFacts& facts);

}  // namespace recald::views
