#include "adapters/sqlite/backup.hpp"

#include <cassert>
#include <utility>

#include "adapters/sqlite/damage.hpp"
#include "adapters/sqlite/tables/handles.hpp"
#include "adapters/system/files/durable_names.hpp"
#include "adapters/system/files/regular_file.hpp"

namespace recald::sqlite {
namespace {

struct FinishBackup {
  void operator()(sqlite3_backup* backup) const { sqlite3_backup_finish(backup); }
};

}  // namespace

struct Backup::Impl {
  std::filesystem::path file;
  std::filesystem::path part;
  DatabaseHandle copy;
  std::unique_ptr<sqlite3_backup, FinishBackup> backup;  ///< Ends before the copy is closed.

  ~Impl() {
    backup.reset();
    copy.reset();
    std::error_code ignored;
    for (const char* log : {"", "-wal", "-shm"}) {
      std::filesystem::remove(part.string() + log, ignored);
    }
  }
};

Backup::Backup(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Backup::~Backup() = default;
Backup::Backup(Backup&&) noexcept = default;
Backup& Backup::operator=(Backup&&) noexcept = default;

Result<Backup> Backup::begin(Database& database, const std::filesystem::path& file) {
  auto impl = std::make_unique<Impl>();
  impl->file = file;
  impl->part = file.string() + ".part";
  std::error_code ignored;
  std::filesystem::remove(impl->part, ignored);
  system::make_private_file(impl->part);
  sqlite3* raw = nullptr;
  const int opened = sqlite3_open_v2(impl->part.c_str(), &raw,
                                     SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  impl->copy.reset(raw);
  if (opened != SQLITE_OK) return failed(opened, raw, impl->part.string());
  impl->backup.reset(sqlite3_backup_init(raw, "main", database.impl_->handle.get(), "main"));
  if (!impl->backup) return failed(sqlite3_errcode(raw), raw, impl->part.string());
  return Backup{std::move(impl)};
}

Result<bool> Backup::step(int pages) {
  const int result = sqlite3_backup_step(impl_->backup.get(), pages);
  if (result == SQLITE_OK) return false;
  if (result != SQLITE_DONE) return failed(result, nullptr, impl_->part.string());
  impl_->backup.reset();
  impl_->copy.reset();
  return true;
}

Result<std::string> Backup::check(const std::stop_token& stop) {
  assert(!impl_->copy && "the copy is whole");
  return damage_of(impl_->part, {}, stop);
}

Result<void> Backup::keep() { return system::rename_durably(impl_->part, impl_->file); }

}  // namespace recald::sqlite
