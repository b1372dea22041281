/// What a store has of the meters of a gateway, as far as what comes in afterwards depends on it.
#pragma once

#include <functional>
#include <span>

#include "adapters/ports/store.hpp"
#include "daemon/gateway/ingest/month_keeper.hpp"
#include "daemon/gateway/recording/line.hpp"

namespace recald::daemon::recording {

/// Calls visit for the lines that describe it: the events of the last day, and of each meter the
/// states of its registers, its months, and its readings of the last 32 days and of all months that
/// may still close.
/// @return or the store's failure.
[[nodiscard]] Result<void> for_each_known(Store& store, const metering::LocalCalendar& calendar,
                                          std::span<const StoredMeter> meters,
                                          const std::function<void(const Line&)>& visit);

/// Puts one of these lines into a store that has had all before it. Others are ignored.
/// @return or the store's failure; malformed for a meter that no line before has described.
[[nodiscard]] Result<void> put_known(Store& store, const Line& line);

}  // namespace recald::daemon::recording
