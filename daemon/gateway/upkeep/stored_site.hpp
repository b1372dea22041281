/// The meters of a site that its store knows, in the site file's order.
#pragma once

#include <vector>

#include "adapters/sqlite/sqlite_store.hpp"
#include "daemon/gateway/ingest/month_keeper.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// @return or not_found when the store has none of them.
[[nodiscard]] Result<std::vector<StoredMeter>> stored_meters(sqlite::SqliteStore& store,
                                                             const SiteConfig& site);

/// Opens a site's store to read, beside a daemon if one runs.
/// @return or not_found when there is none yet.
[[nodiscard]] Result<sqlite::SqliteStore> open_to_read(const SiteConfig& site);

}  // namespace recald::daemon
