#include "adapters/sqlite/sqlite_store.hpp"

#include <fmt/format.h>

#include <cassert>
#include <utility>

#include "adapters/sqlite/backup.hpp"
#include "adapters/sqlite/row_checks.hpp"
#include "adapters/sqlite/tables/edit_table.hpp"
#include "adapters/sqlite/tables/forecast_table.hpp"
#include "adapters/sqlite/tables/job_table.hpp"
#include "adapters/sqlite/tables/month_table.hpp"
#include "adapters/sqlite/tables/outbox_table.hpp"
#include "adapters/sqlite/tables/register_json.hpp"
#include "adapters/sqlite/tables/rows.hpp"
#include "adapters/sqlite/tables/sample_table.hpp"
#include "adapters/sqlite/tables/schema.hpp"
#include "adapters/sqlite/tables/tables.hpp"
#include "core/text/limited.hpp"

namespace recald::sqlite {

using metering::Instant;
using metering::MonthlyFigure;

namespace {

constexpr std::string_view kEventColumns = "t, severity, kind, subject, text, count, last, number";

StoreEvent read_event(Columns columns) {
  const auto text = [&](std::size_t bytes_max) {
    return limited(columns.next<std::string>(), bytes_max);
  };
  return {.time = columns,
          .severity = columns,
          .kind = text(kEventWordMax),
          .subject = text(kEventWordMax),
          .text = text(kEventTextMax),
          .count = columns,
          .last = columns.next<std::optional<Instant>>(),
          .number = columns};
}

/// Until they exceed `kEventsBytesMax`.
Result<std::vector<StoreEvent>> read_events(Statement& query) {
  std::vector<StoreEvent> events;
  std::size_t bytes = 0;
  while (bytes < kEventsBytesMax) {
    const auto row = TRY(query.step());
    if (!row) break;
    events.push_back(read_event(Columns{query}));
    const StoreEvent& event = events.back();
    bytes += sizeof(StoreEvent) + event.kind.size() + event.subject.size() + event.text.size();
  }
  query.reset();
  return events;
}

}  // namespace

SqliteStore::SqliteStore(Database database, std::optional<BatchWriter> writer)
    : database_(std::move(database)), writer_(std::move(writer)) {}

Result<SqliteStore> SqliteStore::open(const std::filesystem::path& file,
                                      const Database::Options& options) {
  auto database = TRY(Database::open(file, options));
  if (options.access == Database::Access::read_only) {
    TRY(require_current(database));
    return SqliteStore{std::move(database), {}};
  }
  TRY(bring_up_to_date(database));
  auto writer = TRY(BatchWriter::prepare(database));
  return SqliteStore{std::move(database), std::move(writer)};
}

Result<std::uint32_t> SqliteStore::meter_number(const std::string& id,
                                                std::chrono::seconds interval) {
  return write([&]() -> Result<std::uint32_t> {
    auto find = TRY(database_.prepare("SELECT number, interval_s FROM meter WHERE id = ?"));
    const auto row = TRY(bound(find, id).step());
    if (row) {
      if (find.integer(1) != interval.count()) {
        return failure(ErrorCode::unsupported,
                       fmt::format("meter '{}' is stored with intervals of {} s but now has {} s; "
                                   "give it a new id, or its old interval",
                                   id, find.integer(1), interval.count()));
      }
      return static_cast<std::uint32_t>(find.integer(0));
    }
    auto next = TRY(database_.prepare("SELECT coalesce(max(number), -1) + 1 FROM meter"));
    TRY(next.step());
    const std::int64_t number = next.integer(0);
    next.reset();
    auto insert = TRY(database_.prepare(insert_into("meter", 3)));
    TRY(bound(insert, number, id, interval).run());
    return static_cast<std::uint32_t>(number);
  });
}

Result<std::optional<std::uint32_t>> SqliteStore::find_meter(const std::string& id) {
  auto find = TRY(database_.prepare("SELECT number FROM meter WHERE id = ?"));
  const auto row = TRY(bound(find, id).step());
  if (!row) return std::optional<std::uint32_t>{};
  return std::optional{static_cast<std::uint32_t>(find.integer(0))};
}

Result<CommitCounts> SqliteStore::commit(const StoreBatch& batch) {
  assert(writer_ && "a reader does not write");
  return write([&] { return writer_->write(batch); });
}

Result<void> SqliteStore::as_one(const std::function<Result<void>()>& work) {
  return database_.transaction(work);
}

Result<void> SqliteStore::for_each_interval(
    std::uint32_t meter, const metering::TimeSpan& span,
    const std::function<void(const StoredInterval&)>& visit) {
  auto query = TRY(database_.prepare(
      fmt::format("SELECT {} FROM interval WHERE meter = ? AND t_start >= ? AND t_start < ? "
                  "ORDER BY t_start, revision",
                  kIntervalColumns)));
  std::optional<StoredInterval> last;  // of its start; a later revision may follow
  TRY(for_each_row(bound(query, meter, span.begin, span.end), [&](const Statement& row) {
    const StoredInterval next = read_interval(Columns{row}, meter);
    if (last && last->reading.start != next.reading.start) visit(*last);
    last = next;
  }));
  if (last) visit(*last);
  return {};
}

Result<std::optional<metering::TimeSpan>> SqliteStore::interval_extent(std::uint32_t meter) {
  // Two subqueries take one index step each; a single query for both would read all rows.
  auto query =
      TRY(database_.prepare("SELECT (SELECT min(t_start) FROM interval WHERE meter = ?1), "
                            "(SELECT max(t_start) FROM interval WHERE meter = ?1)"));
  const auto row = TRY(bound(query, meter).step());
  if (!row || query.is_null(0)) return std::optional<metering::TimeSpan>{};
  return std::optional{
      metering::TimeSpan{instant_of(query.integer(0)), instant_of(query.integer(1))}};
}

Result<bool> SqliteStore::was_read_in(const metering::TimeSpan& span) {
  // The cross join goes meter by meter, each one step in the index.
  auto query = TRY(database_.prepare(
      "SELECT EXISTS (SELECT 1 FROM meter CROSS JOIN interval ON interval.meter = meter.number "
      "WHERE t_start >= ? AND t_start < ? AND validity = 0)"));
  TRY(bound(query, span.begin, span.end).step());
  return query.integer(0) != 0;
}

Result<std::vector<RegisterState>> SqliteStore::registers(std::uint32_t meter) {
  auto query = TRY(database_.prepare("SELECT state FROM register WHERE meter = ? ORDER BY field"));
  return all_rows(bound(query, meter),
                  [](Columns columns) { return register_from_json(columns.next<std::string>()); });
}

Result<void> SqliteStore::for_each_sample(
    std::uint32_t meter, const std::string& field,
    const std::function<void(const metering::RegisterSample&)>& visit) {
  return sqlite::for_each_sample(database_, meter, field, visit);
}

Result<int> SqliteStore::delete_samples(Instant keep_from, int rows_max) {
  return delete_old_samples(database_, keep_from, rows_max);
}

Result<std::int64_t> SqliteStore::add_edit(const StoreEdit& edit) {
  return write([&] { return insert_edit(database_, edit); });
}

Result<void> SqliteStore::remove_edit(std::int64_t number) {
  return delete_edit(database_, number);
}

Result<std::set<Instant>> SqliteStore::edited_days(std::uint32_t meter) {
  return sqlite::edited_days(database_, meter);
}

Result<std::vector<MeterMonth>> SqliteStore::reopened() { return reopened_months(database_); }

Result<int> SqliteStore::put_month(std::uint32_t meter, const MonthlyFigure& figure,
                                   const std::string& time_zone_release, Instant now) {
  return write([&] { return insert_month(database_, meter, {figure, now, time_zone_release}); });
}

Result<std::vector<StoredMonth>> SqliteStore::months(std::uint32_t meter) {
  return stored_months(database_, meter);
}

Result<std::string> SqliteStore::closing_rules(std::uint32_t meter) {
  return closing_rules_of(database_, meter);
}

Result<int> SqliteStore::put_closing_rules(std::uint32_t meter, const std::string& rules) {
  return write([&] { return replace_closing_rules(database_, meter, rules); });
}

Result<int> SqliteStore::delete_events(Instant keep_from, int rows_max) {
  auto remove = TRY(database_.prepare(
      "DELETE FROM event WHERE number IN (SELECT number FROM event WHERE t < ?1 AND "
      "coalesce(last, t) < ?1 ORDER BY t LIMIT ?2) RETURNING 1"));
  int removed = 0;
  TRY(for_each_row(bound(remove, keep_from, rows_max), [&](const Statement&) { ++removed; }));
  return removed;
}

Result<std::optional<StoredJob>> SqliteStore::oldest_job_beyond(JobKind kind, int kept) {
  return oldest_finished_job_beyond(database_, kind, kept);
}

Result<void> SqliteStore::delete_job(std::int64_t number) { return remove_job(database_, number); }

Result<void> SqliteStore::for_each_event(Instant until,
                                         const std::function<bool(const StoreEvent&)>& visit) {
  auto query = TRY(database_.prepare(fmt::format(
      "SELECT {} FROM event WHERE t <= ? ORDER BY t DESC, number DESC", kEventColumns)));
  bound(query, until);
  for (;;) {
    const auto row = TRY(query.step());
    if (!row || !visit(read_event(Columns{query}))) break;
  }
  query.reset();
  return {};
}

Result<std::set<std::string>> SqliteStore::silent_meters() {
  // The columns before its text alone: how long texts are does not matter.
  auto query =
      TRY(database_.prepare("SELECT subject, kind FROM event WHERE kind IN ('meter_silent', "
                            "'meter_answers') ORDER BY t, number"));
  std::set<std::string> silent;
  TRY(for_each_row(query, [&](const Statement& row) {
    if (row.text(1) == "meter_silent") {
      silent.insert(row.text(0));
    } else {
      silent.erase(row.text(0));
    }
  }));
  return silent;
}

Result<std::vector<StoreEvent>> SqliteStore::events(int limit) {
  auto query = TRY(database_.prepare(
      fmt::format("SELECT {} FROM event ORDER BY t DESC, number DESC LIMIT ?", kEventColumns)));
  return read_events(bound(query, limit));
}

Result<std::vector<StoreEvent>> SqliteStore::events_after(std::int64_t number, int limit) {
  auto query = TRY(database_.prepare(
      fmt::format("SELECT {} FROM event WHERE number > ? ORDER BY number LIMIT ?", kEventColumns)));
  return read_events(bound(query, number, limit));
}

Result<std::optional<std::int64_t>> SqliteStore::cursor(const std::string& destination) {
  auto query = TRY(database_.prepare("SELECT position FROM cursor WHERE destination = ?"));
  const auto row = TRY(bound(query, destination).step());
  return row ? std::optional{query.integer(0)} : std::nullopt;
}

Result<void> SqliteStore::put_cursor(const std::string& destination, std::int64_t position) {
  return write([&]() -> Result<void> {
    auto put = TRY(database_.prepare(insert_into("cursor", 2, "INSERT OR REPLACE")));
    return bound(put, destination, position).run();
  });
}

Result<void> SqliteStore::keep_outbox_for(const std::vector<std::string>& destinations) {
  return write([&] { return sqlite::keep_outbox_for(database_, destinations); });
}

Result<std::vector<OutboxEntry>> SqliteStore::outbox_after(std::int64_t number, int limit) {
  return sqlite::outbox_after(database_, number, limit);
}

Result<OutboxPosition> SqliteStore::outbox_position(const std::string& destination) {
  return sqlite::outbox_position(database_, destination);
}

Result<void> SqliteStore::put_outbox_position(const std::string& destination, std::int64_t number) {
  return write([&] { return sqlite::put_outbox_position(database_, destination, number); });
}

Result<std::int64_t> SqliteStore::add_job(const StoredJob& job) {
  return write([&] { return insert_job(database_, job); });
}

Result<void> SqliteStore::put_job(const StoredJob& job) {
  return write([&] { return update_job(database_, job); });
}

Result<std::optional<StoredJob>> SqliteStore::job(std::int64_t number) {
  return find_job(database_, number);
}

Result<std::vector<StoredJob>> SqliteStore::jobs(JobKind kind, int limit) {
  return newest_jobs(database_, kind, limit);
}

Result<std::optional<StoredJob>> SqliteStore::last_accepted(JobKind kind) {
  return last_accepted_job(database_, kind);
}

Result<std::vector<StoredJob>> SqliteStore::unfinished_jobs() {
  return sqlite::unfinished_jobs(database_);
}

Result<void> SqliteStore::add_forecasts(std::span<const StoredForecast> forecasts) {
  return write([&] { return insert_forecasts(database_, forecasts); });
}

Result<std::vector<StoredForecast>> SqliteStore::forecasts() { return stored_forecasts(database_); }

Result<StoreCheck> SqliteStore::check() {
  auto damage = TRY(database_.quick_check());
  if (!damage.empty()) return StoreCheck{.damage = std::move(damage)};
  auto problems = TRY(row_problems(database_));
  auto sums = TRY(wrong_sums(database_));
  if (!sums.empty()) problems.push_back(std::move(sums));
  const auto intervals = TRY(count_intervals(database_));
  return StoreCheck{.problems = std::move(problems), .intervals = intervals};
}

Result<std::unique_ptr<StoreBackup>> SqliteStore::begin_backup(const std::filesystem::path& file) {
  auto backup = TRY(Backup::begin(database_, file));
  return std::make_unique<Backup>(std::move(backup));
}

}  // namespace recald::sqlite
