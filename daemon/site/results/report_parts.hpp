/// What pages of results have in common.
#pragma once

#include "adapters/views/frame/report_data.hpp"
#include "core/display/unit.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/replay/recording.hpp"

namespace recald::daemon {

[[nodiscard]] views::SiteLine site_line_of(const SiteConfig& site);

/// A meter's hours as a calendar of whole months.
[[nodiscard]] views::LoadGrid load_of(const MeterRecord& record, display::UnitSystem system);

}  // namespace recald::daemon
