/// The store of a gateway: one SQLite file. Its tables are described in README.md beside this.
#pragma once

#include <filesystem>
#include <memory>

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/database.hpp"

namespace recald::sqlite {

class SqliteStore final : public Store {
 public:
  /// Opens or creates, brings the schema up to date.
  /// @return as Database::open; unsupported when the file was written by a newer recald.
  [[nodiscard]] static Result<SqliteStore> open(const std::filesystem::path& file,
                                                const Database::Options& options = {});

  Result<std::uint32_t> meter_number(const std::string& id, std::chrono::seconds interval) override;
  Result<CommitCounts> commit(const StoreBatch& batch) override;
  Result<void> for_each_interval(std::uint32_t meter, const metering::TimeSpan& span,
                                 const std::function<void(const StoredInterval&)>& visit) override;
  Result<std::optional<metering::TimeSpan>> interval_extent(std::uint32_t meter) override;
  Result<std::vector<RegisterState>> registers(std::uint32_t meter) override;
  Result<std::vector<MeterMonth>> reopened() override;
  Result<int> put_month(std::uint32_t meter, const metering::MonthlyFigure& figure,
                        const std::string& time_zone_release, metering::Instant now) override;
  Result<std::vector<metering::MonthlyFigure>> months(std::uint32_t meter) override;
  Result<std::vector<StoreEvent>> events(int limit) override;
  Result<std::int64_t> add_job(const StoredJob& job) override;
  Result<void> put_job(const StoredJob& job) override;
  Result<std::optional<StoredJob>> job(std::int64_t number) override;
  Result<std::vector<StoredJob>> jobs(JobKind kind, int limit) override;
  Result<std::optional<StoredJob>> last_accepted(JobKind kind) override;
  Result<std::vector<StoredJob>> unfinished_jobs() override;

  [[nodiscard]] Database& database() { return database_; }

 private:
  struct Statements;

  SqliteStore(Database database, std::unique_ptr<Statements> statements);
  [[nodiscard]] Result<void> put_interval(const StoreBatch::Interval& interval,
                                          CommitCounts& counts);
  [[nodiscard]] Result<std::optional<StoredInterval>> latest(std::uint32_t meter,
                                                             metering::Instant start);

  Database database_;
  std::shared_ptr<Statements> statements_;  ///< After the database: they end first.
};

}  // namespace recald::sqlite
