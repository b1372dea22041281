/// Intervals and months as points of a time series.
#pragma once

#include <vector>

#include "adapters/series/point.hpp"
#include "core/metering/civil_time.hpp"
#include "daemon/gateway/forward/outbox/sink.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// `recald_interval` at the end of each interval, `recald_weather_interval` likewise, and
/// `recald_month` at the end of each month. README.md in this folder lists fields and labels.
[[nodiscard]] std::vector<series::Point> series_points(const SiteConfig& site,
                                                       const metering::LocalCalendar& calendar,
                                                       const OutgoingBatch& batch);

}  // namespace recald::daemon
