#include "adapters/stores/open.hpp"

#include <utility>

#include "adapters/sqlite/recovery.hpp"
#include "adapters/sqlite/sqlite_store.hpp"

namespace recald::stores {
namespace {

Result<std::unique_ptr<Store>> open(const std::filesystem::path& file,
                                    sqlite::Database::Access access) {
  auto store = sqlite::SqliteStore::open(file, {.access = access, .vfs = {}});
  if (!store) return tl::unexpected(store.error());
  return std::make_unique<sqlite::SqliteStore>(std::move(*store));
}

}  // namespace

Result<std::unique_ptr<Store>> open_to_read(const std::filesystem::path& file) {
  return open(file, sqlite::Database::Access::read_only);
}

Result<std::unique_ptr<Store>> open_in_memory() {
  return open(":memory:", sqlite::Database::Access::read_write);
}

Result<CheckedStore> open_checked(const std::filesystem::path& file,
                                  const std::vector<std::filesystem::path>& backups,
                                  metering::Instant now, const std::function<void()>& on_progress) {
  auto opened = sqlite::open_checked(file, backups, now, on_progress);
  if (!opened) return tl::unexpected(opened.error());
  return CheckedStore{std::make_unique<sqlite::SqliteStore>(std::move(opened->store)),
                      opened->recovery ? opened->recovery->sentence() : std::string{}};
}

}  // namespace recald::stores
