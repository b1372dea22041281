/// A store's readings and months as CSV.
#pragma once

#include <ostream>
#include <span>

#include "adapters/ports/interval_store.hpp"
#include "adapters/ports/month_store.hpp"
#include "daemon/gateway/ingest/month_keeper.hpp"

namespace recald::daemon {

/// `timestamp,meter,value,unit,validity,late,reasons`: the reading in force for each interval
/// that starts in the span, meter by meter. Values are mean kW with all digits, so an import
/// gives the same readings.
[[nodiscard]] Result<void> export_readings(IntervalStore& store,
                                           std::span<const StoredMeter> meters,
                                           const metering::TimeSpan& span, std::ostream& out);

/// `month,meter,value,unit,coverage,filled_share,peak_kW,peak_at,method,revision,tzdata`: the
/// latest figure of each closed month that begins in the span; value is the daily average.
[[nodiscard]] Result<void> export_months(MonthStore& store, const metering::LocalCalendar& calendar,
                                         std::span<const StoredMeter> meters,
                                         const metering::TimeSpan& span, std::ostream& out);

}  // namespace recald::daemon
