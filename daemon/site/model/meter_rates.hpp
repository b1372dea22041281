/// What a recorded meter's use costs and emits.
#pragma once

#include "core/tariff/tariff.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/replay/recording.hpp"

namespace recald::daemon {

/// By the site's [tariff] and [emissions]; the price of a kWh is the mean over all its hours.
[[nodiscard]] tariff::Rates rates_of(const SiteConfig& site, const MeterRecord& record);

}  // namespace recald::daemon
