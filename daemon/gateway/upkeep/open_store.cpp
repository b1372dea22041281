#include "daemon/gateway/upkeep/open_store.hpp"

#include "daemon/gateway/upkeep/backups.hpp"

namespace recald::daemon {

Result<sqlite::CheckedStore> open_store(const StoreConfig& config, metering::Instant now) {
  auto opened = sqlite::open_checked(config.file, backups_of(config), now);
  if (!opened || !opened->recovery) return opened;
  const auto told = opened->store.commit(
      {.events = {{now, Severity::error, "store_recovered", "", opened->recovery->sentence()}}});
  if (!told) return tl::unexpected(told.error());
  return opened;
}

}  // namespace recald::daemon
