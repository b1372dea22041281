/// The store of a gateway: one SQLite file. README.md in this folder describes its tables.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/batch_writer.hpp"
#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

class SqliteStore final : public Store {
 public:
  /// Opens or creates a store and brings its schema up to date. Read only, it is for a thread
  /// or process other than the daemon's: it sees what is committed, never waits for the daemon
  /// and never writes.
  /// @return the store, or as Database::open; unsupported when the file was written by a newer
  ///         recald, or, if read only, by an older one.
  [[nodiscard]] static Result<SqliteStore> open(const std::filesystem::path& file,
                                                const Database::Options& options = {});

  Result<std::uint32_t> meter_number(const std::string& id, std::chrono::seconds interval) override;
  Result<std::optional<std::uint32_t>> find_meter(const std::string& id) override;
  Result<CommitCounts> commit(const StoreBatch& batch) override;
  void on_refusal(std::function<bool()> make_room) override { make_room_ = std::move(make_room); }
  Result<void> as_one(const std::function<Result<void>()>& work) override;
  Result<void> for_each_interval(std::uint32_t meter, const metering::TimeSpan& span,
                                 const std::function<void(const StoredInterval&)>& visit) override;
  Result<std::optional<metering::TimeSpan>> interval_extent(std::uint32_t meter) override;
  Result<bool> was_read_in(const metering::TimeSpan& span) override;
  Result<std::vector<RegisterState>> registers(std::uint32_t meter) override;
  Result<void> for_each_sample(
      std::uint32_t meter, const std::string& field,
      const std::function<void(const metering::RegisterSample&)>& visit) override;
  Result<int> delete_samples(metering::Instant keep_from, int rows_max) override;
  Result<std::int64_t> add_edit(const StoreEdit& edit) override;
  Result<void> remove_edit(std::int64_t number) override;
  Result<std::set<metering::Instant>> edited_days(std::uint32_t meter) override;
  Result<std::vector<MeterMonth>> reopened() override;
  Result<int> put_month(std::uint32_t meter, const metering::MonthlyFigure& figure,
                        const std::string& time_zone_release, metering::Instant now) override;
  Result<std::vector<StoredMonth>> months(std::uint32_t meter) override;
  Result<std::string> closing_rules(std::uint32_t meter) override;
  Result<int> put_closing_rules(std::uint32_t meter, const std::string& rules) override;
  Result<int> delete_events(metering::Instant keep_from, int rows_max) override;
  Result<std::vector<StoreEvent>> events(int limit) override;
  Result<void> for_each_event(metering::Instant until,
                              const std::function<bool(const StoreEvent&)>& visit) override;
  Result<std::vector<StoreEvent>> events_after(std::int64_t number, int limit) override;
  Result<std::set<std::string>> silent_meters() override;
  Result<std::optional<std::int64_t>> cursor(const std::string& destination) override;
  Result<void> put_cursor(const std::string& destination, std::int64_t position) override;
  Result<void> keep_outbox_for(const std::vector<std::string>& destinations) override;
  Result<std::vector<OutboxEntry>> outbox_after(std::int64_t number, int limit) override;
  Result<OutboxPosition> outbox_position(const std::string& destination) override;
  Result<void> put_outbox_position(const std::string& destination, std::int64_t number) override;
  Result<std::int64_t> add_job(const StoredJob& job) override;
  Result<void> put_job(const StoredJob& job) override;
  Result<std::optional<StoredJob>> job(std::int64_t number) override;
  Result<std::vector<StoredJob>> jobs(JobKind kind, int limit) override;
  Result<std::optional<StoredJob>> oldest_job_beyond(JobKind kind, int kept) override;
  Result<void> delete_job(std::int64_t number) override;
  Result<std::optional<StoredJob>> last_accepted(JobKind kind) override;
  Result<std::vector<StoredJob>> unfinished_jobs() override;
  Result<void> add_forecasts(std::span<const StoredForecast> forecasts) override;
  Result<std::vector<StoredForecast>> forecasts() override;
  Result<StoreCheck> check() override;
  Result<std::unique_ptr<StoreBackup>> begin_backup(const std::filesystem::path& file) override;

  [[nodiscard]] Database& database() { return database_; }

 private:
  SqliteStore(Database database, std::optional<BatchWriter> writer);

  /// One transaction. If the disk refuses it and room can be made, it is tried once more.
  template <class Work>
  [[nodiscard]] auto write(const Work& work) -> decltype(work()) {
    auto done = database_.transaction(work);
    const bool is_refused = !done && done.error().code == ErrorCode::io_failed;
    if (is_refused && make_room_ && make_room_()) done = database_.transaction(work);
    return done;
  }

  Database database_;
  std::optional<BatchWriter> writer_;  ///< After the database, so that its statements end first.
  std::function<bool()> make_room_;
};

}  // namespace recald::sqlite
