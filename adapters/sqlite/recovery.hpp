/// A store that is damaged: kept aside, and all that can still be read of it in a new one.
///
/// Page by page, and not by the `.recover` of the sqlite3 program: Debian's library does not
/// contain that, and a daemon should not depend on a program beside it. What lies on a page that
/// cannot be read, or has a wrong check sum, comes from a backup where one has it, and intervals
/// else from samples of their register.
///
/// The process may end at any step. "FILE.recovery" says that a recovery has begun; the new store
/// is made as "FILE.recovering" and takes its place by one rename. Who opens the store next goes
/// on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adapters/sqlite/salvage.hpp"
#include "adapters/sqlite/sqlite_store.hpp"

namespace recald::sqlite {

struct RecoveredTable {
  std::string name;
  std::int64_t from_damaged = 0;  ///< Rows.
  std::int64_t from_backup = 0;
};

struct Recovery {
  std::string damage;             ///< In SQLite's words.
  std::filesystem::path damaged;  ///< The file as it was, under its new name.
  std::optional<std::filesystem::path> backup;
  std::vector<RecoveredTable> tables;
  std::int64_t refused = 0;         ///< Rows of the damaged file whose check sum is wrong.
  std::int64_t from_samples = 0;    ///< Intervals.
  std::int64_t lost_intervals = 0;  ///< That lie between others and are in no source.
  bool was_interrupted = false;     ///< An earlier process had begun it.
  bool is_overtaken = false;        ///< And another store has taken its place meanwhile.

  /// What happened, for a log and for people.
  [[nodiscard]] std::string sentence() const;
};

struct CheckedStore {
  SqliteStore store;
  std::optional<Recovery> recovery;  ///< Absent: the file was sound, or new.
};

/// Opens a store to write after looking it through: its structure (`quick_check`) and its rows'
/// check sums. A damaged file becomes "FILE.damaged-<time>", with its log, and a new one takes its
/// place, in which an event "store_recovered" tells of it.
///
/// @param backups  The newest first; the first that is sound is used, and only for what is damaged.
/// @pre  nobody else has the store open.
/// @return or as SqliteStore::open; unsupported when the file is another program's database, which
///         is left alone; io_failed when it cannot be put aside or the new one not be written:
///         nothing is lost, and the next call goes on.
[[nodiscard]] Result<CheckedStore> open_checked(const std::filesystem::path& file,
                                                const std::vector<std::filesystem::path>& backups,
                                                metering::Instant now,
                                                const OnProgress& on_progress = {});

}  // namespace recald::sqlite
