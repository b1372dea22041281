/// Opens a site's store, whatever keeps it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adapters/ports/store.hpp"

namespace recald::stores {

/// For another thread or process than the daemon's: sees what is committed, never waits for the
/// daemon and never writes.
/// @return or io_failed: cannot be opened; malformed: no store, or a damaged one; unsupported:
///         written by a newer or an older recald, or by another program.
[[nodiscard]] Result<std::unique_ptr<Store>> open_to_read(const std::filesystem::path& file);

/// A store that lives as long as the value: for a time without a disk.
[[nodiscard]] Result<std::unique_ptr<Store>> open_in_memory();

struct CheckedStore {
  std::unique_ptr<Store> store;
  std::string recovery;  ///< What was damaged and what could be read of it; empty: it was sound.
};

/// Opens or creates a store to write after looking it through, and brings an older one up to date.
/// A damaged one is put aside, and what can still be read of it stands in a new one. There is no
/// other way to write to one: whoever made a new store while a recovery waits to go on would hide
/// all that the old one holds.
/// @param backups      The newest first; the first that is sound is used, and only for what is
///                     damaged.
/// @param on_progress  Told now and then that it goes on; a large store takes minutes. May be
///                     empty.
/// @pre  nobody else has the store open.
/// @return or io_failed: cannot be opened, disk full, in use by another writer, or a damaged one
///         cannot be put aside or written anew: then nothing is lost, and the next call goes on;
///         unsupported: written by a newer recald, or by another program.
[[nodiscard]] Result<CheckedStore> open_checked(const std::filesystem::path& file,
                                                const std::vector<std::filesystem::path>& backups,
                                                metering::Instant now,
                                                const std::function<void()>& on_progress = {});

}  // namespace recald::stores
