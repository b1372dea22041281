/// A site's store as the daemon opens it: looked through, put right, with room in reserve.
#pragma once

#include "adapters/stores/open.hpp"
#include "daemon/site/config/store_config.hpp"

namespace recald::daemon {

/// Opens the store; a damaged one is recovered with the help of the daily backups, and an event
/// "store_recovered" tells of it.
/// @return or as stores::open_checked.
[[nodiscard]] Result<stores::CheckedStore> open_store(const StoreConfig& config,
                                                      metering::Instant now);

}  // namespace recald::daemon
