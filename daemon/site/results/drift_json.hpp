/// drift.json: what the daemon keeps and serves of a followed site.
#pragma once

#include <string>

#include "daemon/site/drift/site_drift.hpp"
#include "daemon/site/model/run_facts.hpp"

namespace recald::daemon {

/// Ends with a line feed; the same bytes for the same site, readings and seed, but for `wall_s`.
[[nodiscard]] std::string drift_json(const SiteDrift& drift, const RunFacts& facts);

}  // namespace recald::daemon
