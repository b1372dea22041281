/// The daily copies of a store: their names, and which to keep.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "daemon/site/config/service/store_config.hpp"

namespace recald::daemon {

inline constexpr std::size_t kBackupsKept = 7;

/// "site-2024-03-01.db" in the backup folder, one per local day.
[[nodiscard]] std::filesystem::path backup_file(const StoreConfig& store, metering::Day day);

/// Complete backups of this store, newest first; other files in the folder are ignored.
[[nodiscard]] std::vector<std::filesystem::path> backups_of(const StoreConfig& store);

/// The local day in a backup's name. @pre one of backups_of
[[nodiscard]] metering::Day day_of(const StoreConfig& store, const std::filesystem::path& backup);

/// Deletes all but the newest kBackupsKept. While a damaged store lies beside this one, backups
/// from before the damage stay too, because they may hold what was lost. If it is not clear whether
/// there is one, all stay.
/// @return what could not be deleted.
std::vector<std::filesystem::path> prune_backups(const StoreConfig& store);

}  // namespace recald::daemon
