/// The daily copies of a store: what they are called, which are kept.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "daemon/site/config/store_config.hpp"

namespace recald::daemon {

inline constexpr std::size_t kBackupsKept = 7;

/// "site-2024-03-01.db" in the backup folder: one a local day.
[[nodiscard]] std::filesystem::path backup_file(const StoreConfig& store, metering::Day day);

/// Whole backups of this store, the newest first; other files of the folder are none of ours.
[[nodiscard]] std::vector<std::filesystem::path> backups_of(const StoreConfig& store);

/// The local day of a backup, as its name says. @pre one of backups_of
[[nodiscard]] metering::Day day_of(const StoreConfig& store, const std::filesystem::path& backup);

/// Deletes all but the newest kBackupsKept. As long as a damaged store lies beside this one, those
/// from before the damage stay as well: they may have what was lost. Where it cannot be seen
/// whether one does, all stay.
/// @return what could not be deleted.
std::vector<std::filesystem::path> prune_backups(const StoreConfig& store);

}  // namespace recald::daemon
