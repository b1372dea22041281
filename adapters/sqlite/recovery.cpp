#include "adapters/sqlite/recovery.hpp"

#include <fmt/format.h>

#include <fstream>
#include <utility>

#include "adapters/sqlite/salvage.hpp"
#include "adapters/sqlite/schema.hpp"

namespace recald::sqlite {
namespace {

/// What SQLite finds wrong with a file; empty: nothing, or there is no file. Another program's
/// database and a newer version are errors, not damage.
Result<std::string> damage_of(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return std::string{};
  auto database = Database::open(file, {});
  if (!database) {
    if (database.error().code == ErrorCode::malformed) return database.error().message;
    return tl::unexpected(database.error());
  }
  // A header that is another program's is a header that can be read.
  if (auto version = schema_version(*database); !version) return tl::unexpected(version.error());
  return database->quick_check();
}

/// "20240301T051500Z", for a file's name.
std::string stamp_of(metering::Instant t) {
  std::string stamp = metering::to_string(t);
  std::erase_if(stamp, [](char c) { return c == '-' || c == ':'; });
  return stamp;
}

/// The file and its log, which belong together.
Result<std::filesystem::path> put_aside(const std::filesystem::path& file, metering::Instant now) {
  const std::filesystem::path aside = fmt::format("{}.damaged-{}", file.string(), stamp_of(now));
  for (const char* part : {"-wal", "-shm", ""}) {
    const std::filesystem::path from = file.string() + part;
    std::error_code error;
    if (!std::filesystem::exists(from, error)) continue;
    std::filesystem::rename(from, aside.string() + part, error);
    if (!error) continue;
    return failure(ErrorCode::io_failed,
                   fmt::format("the damaged store '{}' cannot be put aside as '{}': {}",
                               from.string(), aside.string(), error.message()));
  }
  return aside;
}

std::optional<std::filesystem::path> first_sound(
    const std::vector<std::filesystem::path>& backups) {
  for (const std::filesystem::path& backup : backups) {
    auto database = Database::open(backup, {.access = Database::Access::read_only});
    if (!database) continue;
    const auto damage = database->quick_check();
    const auto version = schema_version(*database);
    if (damage && damage->empty() && version && *version > 0) return backup;
  }
  return {};
}

/// Copies all tables out of one file. @param rows  Where a table's number of rows is entered.
Result<void> salvage_all(Database& from, Database& to, std::vector<RecoveredTable>& tables,
                         std::int64_t RecoveredTable::*rows, bool is_damaged) {
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const auto copied = salvage(from, to, salvaged_tables()[i]);
    if (!copied) return tl::unexpected(copied.error());
    tables[i].*rows = copied->rows;
    if (is_damaged) tables[i].is_whole = copied->is_whole;
  }
  return {};
}

Result<void> fill(Database& to, Recovery& recovery) {
  for (const SalvagedTable& table : salvaged_tables()) recovery.tables.push_back({table.name});
  auto damaged = Database::open(recovery.damaged, {.access = Database::Access::read_only});
  auto backup = recovery.backup
                    ? Database::open(*recovery.backup, {.access = Database::Access::read_only})
                    : Result<Database>{failure(ErrorCode::not_found, "")};
  // Meters first, from wherever they can be read: all else belongs to one.
  const SalvagedTable& meters = salvaged_tables().front();
  for (Result<Database>* source : {&damaged, &backup}) {
    if (!*source) continue;
    if (auto copied = salvage(**source, to, meters); !copied) {
      return tl::unexpected(copied.error());
    }
  }
  if (damaged) {
    if (auto named = name_unknown_meters(*damaged, to); !named) return named;
    if (auto copied =
            salvage_all(*damaged, to, recovery.tables, &RecoveredTable::from_damaged, true);
        !copied) {
      return copied;
    }
  } else {
    for (RecoveredTable& table : recovery.tables) table.is_whole = false;
  }
  if (!backup) return {};
  return salvage_all(*backup, to, recovery.tables, &RecoveredTable::from_backup, false);
}

}  // namespace

std::string Recovery::sentence() const {
  std::string text = fmt::format(
      "the store was damaged ({}); it is kept as '{}' and a new one holds what could be read:",
      damage, damaged.filename().string());
  for (const RecoveredTable& table : tables) {
    if (table.from_damaged + table.from_backup == 0 && table.is_whole) continue;
    text += fmt::format(" {} {}", table.from_damaged, table.name);
    if (table.from_backup > 0) text += fmt::format(" + {} of a backup", table.from_backup);
    text += table.is_whole ? "," : " (not all),";
  }
  text.back() = ';';
  text += backup ? fmt::format(" the backup was '{}'", backup->filename().string())
                 : std::string{" there was no sound backup"};
  return text;
}

Result<CheckedStore> open_checked(const std::filesystem::path& file,
                                  const std::vector<std::filesystem::path>& backups,
                                  metering::Instant now) {
  auto damage = damage_of(file);
  if (!damage) return tl::unexpected(damage.error());
  std::optional<Recovery> recovery;
  if (!damage->empty()) {
    auto aside = put_aside(file, now);
    if (!aside) return tl::unexpected(aside.error());
    recovery = Recovery{.damage = std::move(*damage), .damaged = std::move(*aside)};
    recovery->backup = first_sound(backups);
  }
  auto store = SqliteStore::open(file);
  if (!store) return tl::unexpected(store.error());
  if (recovery) {
    if (auto filled = fill(store->database(), *recovery); !filled) {
      return tl::unexpected(filled.error());
    }
  }
  return CheckedStore{std::move(*store), std::move(recovery)};
}

}  // namespace recald::sqlite
