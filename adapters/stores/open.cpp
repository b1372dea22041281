#include "adapters/stores/open.hpp"

#include <utility>

#include "adapters/sqlite/recovery/recovery.hpp"
#include "adapters/sqlite/recovery/restoration.hpp"
#include "adapters/sqlite/sqlite_store.hpp"
#include "adapters/sqlite/summary.hpp"

namespace recald::stores {
namespace {

Result<std::unique_ptr<Store>> open(const std::filesystem::path& file,
                                    sqlite::Database::Access access) {
  auto store = TRY(sqlite::SqliteStore::open(file, {.access = access, .vfs = {}}));
  return std::make_unique<sqlite::SqliteStore>(std::move(store));
}

}  // namespace

Result<std::unique_ptr<Store>> open_to_read(const std::filesystem::path& file) {
  return open(file, sqlite::Database::Access::read_only);
}

Result<std::unique_ptr<Store>> open_untouched(const std::filesystem::path& file) {
  auto store = TRY(sqlite::SqliteStore::open(file, {.access = sqlite::Database::Access::read_only,
                                                    .vfs = {},
                                                    .is_still = sqlite::is_still(file)}));
  return std::make_unique<sqlite::SqliteStore>(std::move(store));
}

Result<std::unique_ptr<Store>> open_in_memory() {
  return open(":memory:", sqlite::Database::Access::read_write);
}

Result<CheckedStore> open_checked(const std::filesystem::path& file,
                                  const std::vector<std::filesystem::path>& backups,
                                  metering::Instant now, const std::function<void()>& on_progress) {
  auto opened = TRY(sqlite::open_checked(file, backups, now, on_progress));
  return CheckedStore{std::make_unique<sqlite::SqliteStore>(std::move(opened.store)),
                      opened.recovery ? opened.recovery->sentence() : std::string{}};
}

Result<StoreSummary> summary_of(const std::filesystem::path& file) {
  return sqlite::summary_of(file);
}

Result<std::string> quick_damage_of(const std::filesystem::path& file) {
  auto database = sqlite::open_untouched(file);
  if (database) return database->quick_check();
  if (database.error().code == ErrorCode::malformed) return database.error().message;
  return tl::unexpected(database.error());
}

Result<std::unique_ptr<StoreRestoration>> begin_restoration(
    const std::filesystem::path& store, const std::filesystem::path& backup,
    const std::function<void()>& on_progress) {
  return sqlite::begin_restoration(store, backup, on_progress);
}

bool has_unfinished_restoration(const std::filesystem::path& store) {
  return sqlite::has_unfinished_restoration(store);
}

Result<std::filesystem::path> finish_restoration(const std::filesystem::path& store) {
  return sqlite::finish_restoration(store);
}

}  // namespace recald::stores
