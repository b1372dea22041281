/// Opens a site's store of any kind.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adapters/ports/store.hpp"

namespace recald::stores {

/// For a thread or process other than the daemon's: sees what is committed, never waits for the
/// daemon and never writes.
/// @return the store; or io_failed: cannot be opened; malformed: not a store, or a damaged one;
///         unsupported: written by a newer or an older recald, or by another program.
[[nodiscard]] Result<std::unique_ptr<Store>> open_to_read(const std::filesystem::path& file);

/// The same, and no file is made beside the store, as a log's index is by others.
[[nodiscard]] Result<std::unique_ptr<Store>> open_untouched(const std::filesystem::path& file);

/// A store that lives as long as the object, for running without a disk.
[[nodiscard]] Result<std::unique_ptr<Store>> open_in_memory();

struct CheckedStore {
  std::unique_ptr<Store> store;
  std::string recovery;  ///< What was damaged and what could be recovered; empty: no damage.
};

/// Opens or creates a store for writing. Checks it first, and upgrades an older one. A damaged
/// store is put aside, and whatever can still be read is copied into a new one. Stores must be
/// opened for writing only this way: creating a new store while a recovery is pending would hide
/// everything in the old one.
/// @param backups      Newest first; the first sound one is used, and only for what is damaged.
/// @param on_progress  Called from time to time, since a large store takes minutes. May be empty.
/// @pre  nobody else has the store open.
/// @return the store; or io_failed: cannot be opened, disk full, in use by another writer, or a
///         damaged one cannot be put aside or rewritten (then nothing is lost and the next call
///         continues); unsupported: written by a newer recald, or by another program.
[[nodiscard]] Result<CheckedStore> open_checked(const std::filesystem::path& file,
                                                const std::vector<std::filesystem::path>& backups,
                                                metering::Instant now,
                                                const std::function<void()>& on_progress = {});

/// Reads what a store's file has. Writes nothing, not even beside the file.
/// @return the summary, or as open_to_read; an older version is no error.
[[nodiscard]] Result<StoreSummary> summary_of(const std::filesystem::path& file);

/// Checks the structure of a file (SQLite's `quick_check`), which reads all of it. Writes nothing.
/// @return what is damaged; empty: nothing; or io_failed: cannot be read.
[[nodiscard]] Result<std::string> quick_damage_of(const std::filesystem::path& file);

/// Copies a backup beside the store and checks the copy; it takes the store's place once it is
/// kept.
/// @pre  nobody else has the store open to write, and no restoration of it is unfinished.
/// @return io_failed: cannot be read or copied; malformed: damaged or empty; unsupported: written
///         by a newer recald, or by another program.
[[nodiscard]] Result<std::unique_ptr<StoreRestoration>> begin_restoration(
    const std::filesystem::path& store, const std::filesystem::path& backup,
    const std::function<void()>& on_progress = {});

/// Whether a restoration was decided and its process ended before it was finished; `open_checked`
/// and `finish_restoration` finish it.
[[nodiscard]] bool has_unfinished_restoration(const std::filesystem::path& store);

/// @return the name of the replaced store, empty: none; or io_failed: the next call continues.
[[nodiscard]] Result<std::filesystem::path> finish_restoration(const std::filesystem::path& store);

}  // namespace recald::stores
