/// Puts a backup in the place of a store, and keeps what was there beside it.
///
/// The process may end at any step. The backup is copied to "FILE.restoring" and checked there. One
/// rename, to "FILE.restored-<time>", decides; before it the old store is in place, untouched.
/// After it, whoever opens the store next to write finishes: the old one becomes
/// "FILE.replaced-<time>", together with its log, and the copy becomes FILE.
#pragma once

#include <filesystem>
#include <memory>

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

/// Copies a backup, with its log if it has one, beside the store and checks the copy as a store is
/// checked before it is opened. An older one is brought up to date.
/// @param store  Need not exist; may be damaged.
/// @pre  nobody else has the store open to write, and no restoration of it is unfinished.
/// @return io_failed: cannot be read or copied; malformed: the backup is damaged, or empty;
///         unsupported: written by a newer recald, or by another program.
[[nodiscard]] Result<std::unique_ptr<StoreRestoration>> begin_restoration(
    const std::filesystem::path& store, const std::filesystem::path& backup,
    const OnProgress& on_progress = {});

/// Whether a restoration was decided and is not finished.
[[nodiscard]] bool has_unfinished_restoration(const std::filesystem::path& store);

/// Finishes a restoration that was decided, and removes an undecided copy.
/// @return the name of the replaced store, empty when there was nothing to finish or no store to
///         replace; or io_failed: the next call continues.
Result<std::filesystem::path> finish_restoration(const std::filesystem::path& store);

}  // namespace recald::sqlite
