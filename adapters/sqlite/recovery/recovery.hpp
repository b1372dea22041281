/// Recovers a damaged store: puts the file aside and copies everything readable into a new one.
///
/// It works page by page. The `.recover` of the sqlite3 program is not in Debian's library, and a
/// daemon should not depend on an external program. Rows on unreadable pages or with wrong
/// checksums come from a backup, if one has them; otherwise intervals are rebuilt from the samples
/// of their register.
///
/// The process may end at any step. "FILE.recovery" records that a recovery has begun; the new
/// store is built as "FILE.recovering" and takes its place by one rename. The next process to open
/// the store continues.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adapters/sqlite/recovery/salvage.hpp"
#include "adapters/sqlite/sqlite_store.hpp"

namespace recald::sqlite {

struct RecoveredTable {
  std::string name;
  std::int64_t from_damaged = 0;  ///< Rows.
  std::int64_t from_backup = 0;
};

struct Recovery {
  std::string damage;             ///< In SQLite's words.
  std::filesystem::path damaged;  ///< The damaged file under its new name.
  std::optional<std::filesystem::path> backup;
  std::vector<RecoveredTable> tables;
  std::int64_t refused = 0;         ///< Rows of the damaged file with a wrong checksum.
  std::int64_t from_samples = 0;    ///< Intervals.
  std::int64_t lost_intervals = 0;  ///< Between others, and not found in any source.
  bool was_interrupted = false;     ///< An earlier process began it.
  bool is_overtaken = false;        ///< Another store has since taken its place.

  /// What happened, for the log and for people.
  [[nodiscard]] std::string sentence() const;
};

struct CheckedStore {
  SqliteStore store;
  std::optional<Recovery> recovery;  ///< Absent: the file was sound, or new.
};

/// Opens a store to write after finishing a restoration (`restoration.hpp`) and checking its
/// structure (`quick_check`) and its rows' checksums. A damaged file becomes "FILE.damaged-<time>",
/// with its log, and is replaced by a new one, in which an event "store_recovered" reports this.
///
/// @param backups  Newest first; the first sound one is used, and only for what is damaged.
/// @pre  nobody else has the store open.
/// @return the store, or as SqliteStore::open; unsupported when the file is another program's
///         database, which is left alone; io_failed when it cannot be put aside or the new one
///         cannot be written: nothing is lost, and the next call continues.
[[nodiscard]] Result<CheckedStore> open_checked(const std::filesystem::path& file,
                                                const std::vector<std::filesystem::path>& backups,
                                                metering::Instant now,
                                                const OnProgress& on_progress = {});

}  // namespace recald::sqlite
