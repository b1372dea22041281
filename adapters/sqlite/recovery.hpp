/// A store that is damaged: put aside, and what can still be read of it in a new one.
///
/// Row by row through SQL, and not by the `.recover` of the sqlite3 program: Debian's library does
/// not contain that, and a daemon should not depend on a program beside it. What lies on a page
/// that cannot be read is skipped by narrowing down the keys; the rest of the table is not lost
/// with it. A backup fills what it knows of the hole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adapters/sqlite/sqlite_store.hpp"

namespace recald::sqlite {

struct RecoveredTable {
  std::string name;
  std::int64_t from_damaged = 0;  ///< Rows.
  std::int64_t from_backup = 0;
  bool is_whole = true;  ///< Every row of the damaged file's table could be read.
};

struct Recovery {
  std::string damage;             ///< In SQLite's words.
  std::filesystem::path damaged;  ///< The file as it was, under its new name.
  std::optional<std::filesystem::path> backup;
  std::vector<RecoveredTable> tables;

  /// What happened, for a log and for people.
  [[nodiscard]] std::string sentence() const;
};

struct CheckedStore {
  SqliteStore store;
  std::optional<Recovery> recovery;  ///< Absent: the file was sound, or new.
};

/// Opens a store to write after looking it through (`quick_check`). A damaged file becomes
/// "FILE.damaged-<time>", with its log, and a new one takes its place.
///
/// @param backups  The newest first; the first that is sound is used, and only for what is damaged.
/// @pre  nobody else has the store open.
/// @return or as SqliteStore::open; malformed when the file is another program's database, which is
///         left alone; io_failed when it cannot be put aside.
[[nodiscard]] Result<CheckedStore> open_checked(const std::filesystem::path& file,
                                                const std::vector<std::filesystem::path>& backups,
                                                metering::Instant now);

}  // namespace recald::sqlite
