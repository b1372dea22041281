/// Opens a site's store as the daemon does: checked, recovered if damaged, with space in reserve.
#pragma once

#include "adapters/stores/open.hpp"
#include "daemon/site/config/service/store_config.hpp"

namespace recald::daemon {

/// The file that Upkeep keeps in reserve beside the store.
[[nodiscard]] std::filesystem::path reserve_file(const StoreConfig& config);

/// Opens the store. A damaged one is recovered with the help of the daily backups, and an event
/// "store_recovered" reports it. On a full disk the reserve is released.
/// @param on_progress  Called from time to time; may be empty.
/// @return the store, or as stores::open_checked.
[[nodiscard]] Result<stores::CheckedStore> open_store(
    const StoreConfig& config, metering::Instant now,
    const std::function<void()>& on_progress = {});

}  // namespace recald::daemon
