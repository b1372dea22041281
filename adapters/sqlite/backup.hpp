/// Makes a consistent copy of a database in portions, while the database is still being written.
#pragma once

#include <filesystem>
#include <memory>

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

/// The copy grows beside its target as "….part"; abandoned before it is kept, it leaves nothing.
/// What the connection writes meanwhile also goes into the copy, so writers never wait.
class Backup final : public StoreBackup {
 public:
  /// @param database  Must outlive the copying.
  /// @return io_failed when the file cannot be created.
  [[nodiscard]] static Result<Backup> begin(Database& database, const std::filesystem::path& file);

  ~Backup() override;
  Backup(Backup&&) noexcept;
  Backup& operator=(Backup&&) noexcept;

  [[nodiscard]] Result<bool> step(int pages) override;
  [[nodiscard]] Result<std::string> check(const std::stop_token& stop) override;
  [[nodiscard]] Result<void> keep() override;

 private:
  struct Impl;
  explicit Backup(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace recald::sqlite
