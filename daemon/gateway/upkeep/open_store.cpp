#include "daemon/gateway/upkeep/open_store.hpp"

#include "adapters/system/reserved_space.hpp"
#include "daemon/gateway/upkeep/backups.hpp"

namespace recald::daemon {

std::filesystem::path reserve_file(const StoreConfig& config) {
  return config.file.string() + ".reserve";
}

Result<stores::CheckedStore> open_store(const StoreConfig& config, metering::Instant now,
                                        const std::function<void()>& on_progress) {
  auto opened = stores::open_checked(config.file, backups_of(config), now, on_progress);
  const bool is_refused = !opened && opened.error().code == ErrorCode::io_failed;
  if (is_refused && system::ReservedSpace{reserve_file(config), 0}.give_up()) {
    opened = stores::open_checked(config.file, backups_of(config), now, on_progress);
  }
  return opened;
}

}  // namespace recald::daemon
