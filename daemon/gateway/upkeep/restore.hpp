/// Puts a backup of a site's store back into place.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "adapters/ports/store.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// The backup that is meant: a file, or the name of one in the backup folder; empty: the newest.
/// @return not_found: there is none.
[[nodiscard]] Result<std::filesystem::path> chosen_backup(const StoreConfig& store,
                                                          const std::filesystem::path& named);

/// What a backup has and what the store had.
struct RestoredStore {
  StoreSummary in_backup;
  std::optional<StoreSummary> in_store;  ///< Absent: there is none, or it cannot be read.
  std::string unreadable;                ///< Why; empty: there is none.
  std::filesystem::path replaced;        ///< Where the store is kept; empty: none, or a dry run.

  /// What the store has and the backup has not, as a sentence.
  [[nodiscard]] std::string loss() const;
};

/// Checks a copy of the backup and puts it in place of the store, which is kept.
/// @param dry_run  Everything but that.
/// @pre  the store's lock is held, and no restoration is unfinished.
/// @return as stores::begin_restoration; invalid_value: it has none of the site's meters, or is the
///         store itself.
[[nodiscard]] Result<RestoredStore> restore_store(const SiteConfig& site,
                                                  const std::filesystem::path& backup,
                                                  metering::Instant now, bool dry_run,
                                                  const std::function<void()>& on_progress = {});

}  // namespace recald::daemon
