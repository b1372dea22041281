/// The meters of a site that its store knows, in the site file's order.
#pragma once

#include <memory>
#include <vector>

#include "adapters/ports/interval_store.hpp"
#include "daemon/gateway/ingest/month_keeper.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// @return the meters, or not_found when the store has none of them.
[[nodiscard]] Result<std::vector<StoredMeter>> stored_meters(IntervalStore& store,
                                                             const SiteConfig& site);

/// Opens a site's store for reading, even while a daemon runs.
/// @return the store, or not_found when there is none yet.
[[nodiscard]] Result<std::unique_ptr<Store>> open_to_read(const SiteConfig& site);

}  // namespace recald::daemon
