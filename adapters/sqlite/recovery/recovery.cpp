#include "adapters/sqlite/recovery/recovery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <utility>

#include "adapters/sqlite/damage.hpp"
#include "adapters/sqlite/recovery/refill.hpp"
#include "adapters/sqlite/recovery/restoration.hpp"
#include "adapters/sqlite/store_files.hpp"
#include "adapters/sqlite/tables/outbox_table.hpp"
#include "adapters/sqlite/tables/schema.hpp"
#include "adapters/system/files/durable_names.hpp"
#include "adapters/system/files/write_file.hpp"

namespace recald::sqlite {
namespace {

namespace fs = std::filesystem;

/// The files of a recovery.
struct Places {
  fs::path store;
  fs::path note;  ///< Records that a recovery has begun, and from what.
  fs::path made;  ///< The new store, until it is complete.

  explicit Places(const fs::path& file)
      : store(file), note(file.string() + ".recovery"), made(file.string() + ".recovering") {}
};

/// Writes two lines: where the damaged file is put, and what was wrong with it.
Result<void> write_note(const Places& places, const Recovery& recovery) {
  return system::write_file(places.note,
                            recovery.damaged.filename().string() + "\n" + recovery.damage + "\n");
}

std::optional<Recovery> read_note(const Places& places) {
  std::ifstream in{places.note};
  std::string name;
  Recovery recovery{.was_interrupted = true};
  if (!std::getline(in, name) || name.empty()) return {};
  std::getline(in, recovery.damage);
  recovery.damaged = places.store.parent_path() / name;
  return recovery;
}

/// Moves the file and its log, which belong together. Parts that are already there stay.
Result<void> put_aside(const Places& places, const fs::path& aside) {
  for (const char* part : kStoreParts) {
    const fs::path from = places.store.string() + part;
    if (!is_there(from)) continue;
    if (auto moved = system::rename_durably(from, aside.string() + part); !moved) return moved;
  }
  return {};
}

/// @return io_failed if one cannot be read now, because it may hold the missing rows.
Result<std::optional<fs::path>> first_sound(const std::vector<fs::path>& backups,
                                            const OnProgress& on_progress) {
  const auto is_unsound = [](const auto& asked) {
    return !asked && asked.error().code != ErrorCode::io_failed;
  };
  for (const fs::path& backup : backups) {
    if (on_progress) on_progress();
    if (!is_there(backup)) continue;
    auto database = Database::open(backup, {.access = Database::Access::read_only});
    if (is_unsound(database)) continue;
    if (!database) return tl::unexpected(database.error());
    database->on_progress(on_progress);
    const auto damage = database->quick_check();
    if (is_unsound(damage)) continue;
    if (!damage) return tl::unexpected(damage.error());
    const auto version = schema_version(*database);
    if (is_unsound(version)) continue;
    if (!version) return tl::unexpected(version.error());
    if (damage->empty() && *version > 0) return backup;
  }
  return std::optional<fs::path>{};
}

/// Copies all tables from one file. @param rows  Receives the number of rows per table.
Result<void> take_rows(const fs::path& file, Database& to, Recovery& recovery,
                       std::int64_t RecoveredTable::*rows, const OnProgress& on_progress) {
  const auto from = TRY(PagedFile::open(file));
  const auto salvaged = TRY(salvage(from, to, on_progress));
  for (RecoveredTable& table : recovery.tables) {
    const auto found = salvaged.rows.find(table.name);
    if (found != salvaged.rows.end()) table.*rows = found->second;
  }
  if (rows == &RecoveredTable::from_damaged) recovery.refused = salvaged.refused;
  return {};
}

Result<void> add_event(SqliteStore& store, const Recovery& recovery, metering::Instant now) {
  const auto time = TRY(time_of_event(store.database(), now));
  const auto added = store.commit(
      {.events = {{time, Severity::error, "store_recovered", "", recovery.sentence()}}});
  return added ? Result<void>{} : tl::unexpected(added.error());
}

Result<void> fill(SqliteStore& made, Recovery& recovery, metering::Instant now,
                  const OnProgress& on_progress) {
  Database& to = made.database();
  for (const TableShape& table : table_shapes()) recovery.tables.push_back({table.name});
  to.on_progress(on_progress);
  // Rows come in order of their pages, so a row may come before the rows it refers to.
  if (auto off = to.execute("PRAGMA foreign_keys=OFF"); !off) return off;
  auto taken =
      take_rows(recovery.damaged, to, recovery, &RecoveredTable::from_damaged, on_progress);
  if (!taken) return taken;
  if (recovery.backup) {
    taken = take_rows(*recovery.backup, to, recovery, &RecoveredTable::from_backup, on_progress);
    if (!taken) return taken;
  }
  if (auto mended = mend_references(to); !mended) return mended;
  if (auto on = to.execute("PRAGMA foreign_keys=ON"); !on) return on;
  const auto refilled = TRY(refill_intervals(made));
  recovery.from_samples = refilled.from_samples;
  recovery.lost_intervals = refilled.still_missing;
  if (auto forgotten = forget_identities(to); !forgotten) return forgotten;
  if (auto added = add_event(made, recovery, now); !added) return added;
  // Moves everything into the one file that is renamed.
  return to.execute("PRAGMA wal_checkpoint(TRUNCATE)");
}

/// Builds the complete new store and replaces the old one with it.
Result<void> make_anew(const Places& places, Recovery& recovery,
                       const std::vector<fs::path>& backups, metering::Instant now,
                       const OnProgress& on_progress) {
  remove_store(places.made);  // left by an interrupted recovery
  recovery.backup = TRY(first_sound(backups, on_progress));
  const auto filled = [&]() -> Result<void> {
    auto made = TRY(SqliteStore::open(places.made));
    return fill(made, recovery, now, on_progress);
  }();
  if (!filled) {
    remove_store(places.made);  // frees space on a disk that may be full
    return filled;
  }
  return system::rename_durably(places.made, places.store);
}

/// Whether an event in the store reports this recovery.
Result<bool> has_event_of(Database& store, const Recovery& recovery) {
  auto query = TRY(
      store.prepare("SELECT 1 FROM event WHERE kind = 'store_recovered' AND instr(text, ?) > 0"));
  return query.bind(0, std::string_view{recovery.damaged.filename().native()}).step();
}

/// After the rename only the note had to be removed, and the new store reports the recovery. A
/// store without that event was put there by someone else: it is used, but the content of the
/// damaged one must not be forgotten.
Result<void> close_note(const Places& places, Recovery& recovery, metering::Instant now) {
  auto store = SqliteStore::open(places.store);
  // A damaged store is examined after the note is removed.
  if (!store && store.error().code != ErrorCode::malformed) return tl::unexpected(store.error());
  if (store) {
    const auto has_event = TRY(has_event_of(store->database(), recovery));
    recovery.is_overtaken = !has_event;
    if (recovery.is_overtaken) {
      // It may be an older one.
      if (auto forgotten = forget_identities(store->database()); !forgotten) return forgotten;
      if (auto added = add_event(*store, recovery, now); !added) return added;
    }
  }
  return system::remove_durably(places.note);
}

Result<std::optional<Recovery>> recover_if_damaged(const Places& places,
                                                   const std::vector<fs::path>& backups,
                                                   metering::Instant now,
                                                   const OnProgress& on_progress) {
  std::optional<Recovery> recovery = read_note(places);
  std::optional<Recovery> overtaken;
  bool is_put_aside = recovery && is_there(recovery->damaged);
  if (is_put_aside && is_there(places.store)) {
    TRY(close_note(places, *recovery, now));
    if (recovery->is_overtaken) overtaken = recovery;
    recovery.reset();
    is_put_aside = false;
  }
  if (!recovery) {
    auto damage = TRY(damage_of(places.store, on_progress));
    if (damage.empty()) return overtaken;
    recovery = Recovery{
        .damage = std::move(damage),
        .damaged = free_name(fmt::format("{}.damaged-{}", places.store.string(), stamp_of(now)))};
    TRY(write_note(places, *recovery));
  }
  if (!is_put_aside) {
    TRY(put_aside(places, recovery->damaged));
  }
  TRY(make_anew(places, *recovery, backups, now, on_progress));
  TRY(system::remove_durably(places.note));
  return recovery;
}

}  // namespace

std::string Recovery::sentence() const {
  if (is_overtaken) {
    return fmt::format(
        "the store was damaged ({}), and another store replaced it before its recovery had ended. "
        "recald uses that store, which does not contain the data of '{}'. To recover those data, "
        "stop recald, move the new store away, and rename the damaged file back",
        damage, damaged.filename().string());
  }
  std::string text = fmt::format(
      "the store was damaged ({}); it is kept as '{}', and a new store has the rows that could be "
      "read:",
      damage, damaged.filename().string());
  for (const RecoveredTable& table : tables) {
    if (table.from_damaged + table.from_backup == 0) continue;
    text += fmt::format(" {} {}", table.from_damaged, table.name);
    if (table.from_backup > 0) text += fmt::format(" + {} from a backup", table.from_backup);
    text += ',';
  }
  text.back() = ';';
  if (refused > 0) text += fmt::format(" {} rows had a wrong checksum;", refused);
  if (from_samples > 0) {
    text += fmt::format(" {} intervals were computed again from samples;", from_samples);
  }
  text += lost_intervals > 0 ? fmt::format(" {} intervals are lost;", lost_intervals)
                             : std::string{" no interval is lost;"};
  text += backup ? fmt::format(" the backup was '{}'", backup->filename().string())
                 : std::string{" there was no intact backup"};
  if (was_interrupted) text += "; the recovery was interrupted and has been repeated";
  return text + ". Delete the damaged file when you no longer need it";
}

Result<CheckedStore> open_checked(const fs::path& file, const std::vector<fs::path>& backups,
                                  metering::Instant now, const OnProgress& on_progress) {
  TRY(finish_restoration(file));
  auto recovery = TRY(recover_if_damaged(Places{file}, backups, now, on_progress));
  auto store = TRY(SqliteStore::open(file));
  return CheckedStore{std::move(store), std::move(recovery)};
}

}  // namespace recald::sqlite
