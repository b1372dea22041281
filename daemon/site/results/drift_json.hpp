/// drift.json: what the daemon keeps and serves of a followed site.
#pragma once

#include <string>

#include "daemon/site/drift/site_drift.hpp"
#include "daemon/site/model/run_facts.hpp"

namespace recald::daemon {

/// Ends with a line feed; the same bytes for the same site, readings and seed, but for `wall_s`.
[[nodiscard]] std::string drift_json(const SiteDrift& drift, const RunFacts& facts);

/// calibration.json with what the site's months say of it: "drift", one entry an output, and
/// "alarms".
/// @param calibration  As calibration_json made it.
[[nodiscard]] std::string with_drift(const std::string& calibration, const SiteDrift& drift);

/// The same for a site that could not be followed: "drift_not_followed", why not.
[[nodiscard]] std::string without_drift(const std::string& calibration, const std::string& why);

}  // namespace recald::daemon
