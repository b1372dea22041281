/// A site as the record of a fleet keeps it.
#pragma once

#include "adapters/record/sites.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// The site's file with every file that a calibration of it reads: weather, recordings, register
/// maps, models and designs.
/// @return invalid_value: a file lies outside the site file's folder, or the site has no model;
///         io_failed: one cannot be read. The sentence names the file.
[[nodiscard]] Result<record::SiteDescription> describe(const OpenSite& site);

}  // namespace recald::daemon
