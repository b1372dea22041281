/// Opens a site's store, whatever keeps it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adapters/ports/store.hpp"

namespace recald::stores {

/// Opens or creates a store, and brings an older one up to date.
/// @return or io_failed: cannot be opened, disk full, in use by another writer; malformed: no
/// store,
///         or a damaged one; unsupported: written by a newer recald, or by another program.
[[nodiscard]] Result<std::unique_ptr<Store>> open_to_write(const std::filesystem::path& file);

/// For another thread or process than the daemon's: sees what is committed, never waits for the
/// daemon and never writes.
/// @return or as open_to_write; unsupported for one that an older recald wrote, as well.
[[nodiscard]] Result<std::unique_ptr<Store>> open_to_read(const std::filesystem::path& file);

/// A store that lives as long as the value: for a time without a disk.
[[nodiscard]] Result<std::unique_ptr<Store>> open_in_memory();

struct CheckedStore {
  std::unique_ptr<Store> store;
  std::string recovery;  ///< What was damaged and what could be read of it; empty: it was sound.
};

/// Opens a store to write after looking it through. A damaged one is put aside, and what can still
/// be read of it stands in a new one.
/// @param backups      The newest first; the first that is sound is used, and only for what is
///                     damaged.
/// @param on_progress  Told now and then that it goes on; a large store takes minutes. May be
/// empty.
/// @pre  nobody else has the store open.
/// @return or as open_to_write; io_failed when a damaged one cannot be put aside or written anew:
///         then nothing is lost, and the next call goes on.
[[nodiscard]] Result<CheckedStore> open_checked(const std::filesystem::path& file,
                                                const std::vector<std::filesystem::path>& backups,
                                                metering::Instant now,
                                                const std::function<void()>& on_progress = {});

}  // namespace recald::stores
