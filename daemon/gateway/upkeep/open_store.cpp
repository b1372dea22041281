#include "daemon/gateway/upkeep/open_store.hpp"

#include <algorithm>
#include <chrono>

#include "adapters/system/files/reserved_space.hpp"
#include "daemon/gateway/upkeep/backups.hpp"

namespace recald::daemon {

std::filesystem::path reserve_file(const StoreConfig& config) {
  return config.file.string() + ".reserve";
}

Result<stores::CheckedStore> open_store(const StoreConfig& config, metering::Instant now,
                                        const std::function<void()>& on_progress) {
  const auto backups = backups_of(config);
  // Damage is found after the newest backup was made, even if the clock has not been set and shows
  // something else. The day in a damaged file's name shows which backups are older.
  if (!backups.empty()) {
    now = std::max<metering::Instant>(now, std::chrono::sys_days{day_of(config, backups.front())});
  }
  auto opened = stores::open_checked(config.file, backups, now, on_progress);
  const bool is_refused = !opened && opened.error().code == ErrorCode::io_failed;
  if (is_refused && system::ReservedSpace{reserve_file(config), 0}.give_up()) {
    opened = stores::open_checked(config.file, backups, now, on_progress);
  }
  return opened;
}

}  // namespace recald::daemon
