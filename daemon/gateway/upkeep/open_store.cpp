#include "daemon/gateway/upkeep/open_store.hpp"

#include "daemon/gateway/upkeep/backups.hpp"

namespace recald::daemon {

Result<stores::CheckedStore> open_store(const StoreConfig& config, metering::Instant now) {
  auto opened = stores::open_checked(config.file, backups_of(config), now);
  if (!opened || opened->recovery.empty()) return opened;
  const auto told = opened->store->commit(
      {.events = {{now, Severity::error, "store_recovered", "", opened->recovery}}});
  if (!told) return tl::unexpected(told.error());
  return opened;
}

}  // namespace recald::daemon
