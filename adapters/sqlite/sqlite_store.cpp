#include "adapters/sqlite/sqlite_store.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <utility>

#include "adapters/sqlite/job_table.hpp"
#include "adapters/sqlite/register_json.hpp"
#include "adapters/sqlite/schema.hpp"
#include "core/metering/placement.hpp"

namespace recald::sqlite {
namespace {

using metering::Instant;
using metering::MonthlyFigure;
using metering::Placement;
using metering::Reading;

std::int64_t seconds_of(Instant t) { return t.time_since_epoch().count(); }
Instant instant_of(std::int64_t seconds) { return Instant{std::chrono::seconds{seconds}}; }

constexpr auto kIntervalColumns = "t_start, revision, mean_kW, validity, late, reasons";

StoredInterval read_interval(const Statement& row, std::uint32_t meter) {
  return {{.meter = meter,
           .start = instant_of(row.integer(0)),
           .mean_kW = row.real(2),
           .validity = static_cast<metering::Validity>(row.integer(3)),
           .reasons = static_cast<metering::Reason>(row.integer(5)),
           .late = row.integer(4) != 0},
          static_cast<int>(row.integer(1))};
}

void bind_month(Statement& insert, std::uint32_t meter, const MonthlyFigure& figure, int revision,
                const std::string& time_zone_release, Instant now) {
  insert.bind(0, std::int64_t{meter})
      .bind(1, std::string_view{metering::to_string(figure.month)})
      .bind(2, std::int64_t{revision})
      .bind(3, seconds_of(now))
      .bind(4, std::string_view{time_zone_release})
      .bind(5, figure.daily_average_kWh)
      .bind(6, figure.daily_average_variance_kWh2);
  if (figure.peak) {
    insert.bind(7, figure.peak->kW)
        .bind(8, seconds_of(figure.peak->start))
        .bind(9, std::int64_t{figure.peak->could_be_exceeded});
  } else {
    insert.bind_null(7).bind_null(8).bind_null(9);
  }
  insert.bind(10, std::int64_t{figure.peak_window.count()})
      .bind(11, figure.coverage)
      .bind(12, figure.filled_share);
  for (int i = 0; i < 5; ++i) {
    insert.bind(13 + i, std::int64_t{figure.slots_by_validity[static_cast<std::size_t>(i)]});
  }
  insert.bind(18, std::int64_t{figure.slots});
  if (figure.usable) {
    insert.bind_null(19);
  } else {
    insert.bind(19, std::string_view{figure.unusable_because});
  }
  insert.bind(20, static_cast<std::int64_t>(figure.reasons));
}

/// Columns as in `kMonthColumns`. @return malformed when the month's name is none.
Result<MonthlyFigure> read_month(const Statement& row) {
  const auto month = metering::parse_month(row.text(0));
  if (!month) return tl::unexpected(month.error());
  MonthlyFigure figure{.month = *month};
  figure.revision = static_cast<int>(row.integer(1));
  figure.daily_average_kWh = row.real(2);
  figure.daily_average_variance_kWh2 = row.real(3);
  if (!row.is_null(4)) {
    figure.peak =
        metering::PeakDemand{row.real(4), instant_of(row.integer(5)), row.integer(6) != 0};
  }
  figure.peak_window = std::chrono::seconds{row.integer(7)};
  figure.coverage = row.real(8);
  figure.filled_share = row.real(9);
  for (int i = 0; i < 5; ++i) {
    figure.slots_by_validity[static_cast<std::size_t>(i)] = static_cast<int>(row.integer(10 + i));
  }
  figure.slots = static_cast<int>(row.integer(15));
  figure.usable = row.is_null(16);
  figure.unusable_because = row.text(16);
  figure.reasons = static_cast<metering::Reason>(row.integer(17));
  return figure;
}

constexpr auto kMonthColumns =
    "month, revision, daily_average_kWh, daily_average_variance, peak_kW, peak_at, "
    "peak_could_be_exceeded, peak_window_s, coverage, filled_share, slots_ok, slots_missing, "
    "slots_filled, slots_scaled, slots_suspect, slots, unusable_because, reasons";

}  // namespace

/// What every commit uses, prepared once.
struct SqliteStore::Statements {
  Statement latest_interval;
  Statement insert_interval;
  Statement put_register;
  Statement insert_sample;
  Statement insert_event;
  Statement reopen_month;
};

SqliteStore::SqliteStore(Database database, std::unique_ptr<Statements> statements)
    : database_(std::move(database)), statements_(std::move(statements)) {}

Result<SqliteStore> SqliteStore::open(const std::filesystem::path& file,
                                      const Database::Options& options) {
  auto database = Database::open(file, options);
  if (!database) return tl::unexpected(database.error());
  if (options.access == Database::Access::read_write) {
    if (auto ready = bring_up_to_date(*database); !ready) return tl::unexpected(ready.error());
  }
  auto latest =
      database->prepare(fmt::format("SELECT {} FROM interval WHERE meter = ? AND t_start = ? "
                                    "ORDER BY revision DESC LIMIT 1",
                                    kIntervalColumns));
  if (!latest) return tl::unexpected(latest.error());
  auto interval = database->prepare("INSERT INTO interval VALUES (?, ?, ?, ?, ?, ?, ?)");
  if (!interval) return tl::unexpected(interval.error());
  auto state = database->prepare("INSERT OR REPLACE INTO register VALUES (?, ?, ?)");
  if (!state) return tl::unexpected(state.error());
  auto sample = database->prepare("INSERT OR IGNORE INTO sample VALUES (?, ?, ?, ?)");
  if (!sample) return tl::unexpected(sample.error());
  auto event = database->prepare("INSERT INTO event VALUES (NULL, ?, ?, ?, ?, ?)");
  if (!event) return tl::unexpected(event.error());
  auto reopen = database->prepare("INSERT OR IGNORE INTO reopened VALUES (?, ?)");
  if (!reopen) return tl::unexpected(reopen.error());
  return SqliteStore{std::move(*database),
                     std::make_unique<Statements>(
                         Statements{std::move(*latest), std::move(*interval), std::move(*state),
                                    std::move(*sample), std::move(*event), std::move(*reopen)})};
}

Result<std::uint32_t> SqliteStore::meter_number(const std::string& id,
                                                std::chrono::seconds interval) {
  return database_.transaction([&]() -> Result<std::uint32_t> {
    auto find = database_.prepare("SELECT number, interval_s FROM meter WHERE id = ?");
    if (!find) return tl::unexpected(find.error());
    const auto row = find->bind(0, std::string_view{id}).step();
    if (!row) return tl::unexpected(row.error());
    if (*row) {
      if (find->integer(1) != interval.count()) {
        return failure(ErrorCode::unsupported,
                       fmt::format("meter '{}' is stored with intervals of {} s and now has {} s; "
                                   "give it another id, or its old interval",
                                   id, find->integer(1), interval.count()));
      }
      return static_cast<std::uint32_t>(find->integer(0));
    }
    auto insert = database_.prepare(
        "INSERT INTO meter VALUES ((SELECT coalesce(max(number), -1) + 1 FROM meter), ?, ?) "
        "RETURNING number");
    if (!insert) return tl::unexpected(insert.error());
    const auto made = insert->bind(0, std::string_view{id}).bind(1, interval.count()).step();
    if (!made) return tl::unexpected(made.error());
    const auto number = static_cast<std::uint32_t>(insert->integer(0));
    if (auto done = insert->run(); !done) return tl::unexpected(done.error());
    return number;
  });
}

Result<std::optional<StoredInterval>> SqliteStore::latest(std::uint32_t meter, Instant start) {
  Statement& query = statements_->latest_interval;
  const auto row = query.bind(0, std::int64_t{meter}).bind(1, seconds_of(start)).step();
  if (!row) return tl::unexpected(row.error());
  if (!*row) return std::optional<StoredInterval>{};
  const StoredInterval found = read_interval(query, meter);
  query.reset();
  return std::optional{found};
}

Result<void> SqliteStore::put_interval(const StoreBatch::Interval& interval, CommitCounts& counts) {
  const Reading& reading = interval.reading;
  const auto known = latest(reading.meter, reading.start);
  if (!known) return tl::unexpected(known.error());
  const std::optional<Reading> known_reading =
      *known ? std::optional{(*known)->reading} : std::nullopt;
  switch (metering::place(known_reading, reading, interval.supersedes)) {
    case Placement::duplicate:
      ++counts.duplicates;
      return {};
    case Placement::weaker:
      ++counts.weaker;
      return {};
    case Placement::conflict:
      counts.conflicts.push_back(reading);
      return {};
    case Placement::first:
    case Placement::replaces:
      break;
  }
  ++counts.taken;
  return statements_->insert_interval.bind(0, std::int64_t{reading.meter})
      .bind(1, seconds_of(reading.start))
      .bind(2, std::int64_t{*known ? (*known)->revision + 1 : 0})
      .bind(3, reading.mean_kW)
      .bind(4, static_cast<std::int64_t>(reading.validity))
      .bind(5, std::int64_t{reading.late})
      .bind(6, static_cast<std::int64_t>(reading.reasons))
      .run();
}

Result<CommitCounts> SqliteStore::commit(const StoreBatch& batch) {
  return database_.transaction([&]() -> Result<CommitCounts> {
    CommitCounts counts;
    for (const StoreBatch::Interval& interval : batch.intervals) {
      if (auto put = put_interval(interval, counts); !put) return tl::unexpected(put.error());
    }
    for (const StoreBatch::Register& entry : batch.registers) {
      const auto put = statements_->put_register.bind(0, std::int64_t{entry.meter})
                           .bind(1, std::string_view{entry.state.field})
                           .bind(2, std::string_view{to_json(entry.state)})
                           .run();
      if (!put) return tl::unexpected(put.error());
    }
    for (const RawSample& sample : batch.samples) {
      const auto put = statements_->insert_sample.bind(0, std::int64_t{sample.meter})
                           .bind(1, seconds_of(sample.time))
                           .bind(2, std::string_view{sample.field})
                           .bind(3, sample.value)
                           .run();
      if (!put) return tl::unexpected(put.error());
    }
    for (const StoreEvent& event : batch.events) {
      const auto put = statements_->insert_event.bind(0, seconds_of(event.time))
                           .bind(1, static_cast<std::int64_t>(event.severity))
                           .bind(2, std::string_view{event.kind})
                           .bind(3, std::string_view{event.subject})
                           .bind(4, std::string_view{event.text})
                           .run();
      if (!put) return tl::unexpected(put.error());
    }
    for (const MeterMonth& changed : batch.reopened) {
      const auto put = statements_->reopen_month.bind(0, std::int64_t{changed.meter})
                           .bind(1, std::string_view{metering::to_string(changed.month)})
                           .run();
      if (!put) return tl::unexpected(put.error());
    }
    return counts;
  });
}

Result<void> SqliteStore::for_each_interval(
    std::uint32_t meter, const metering::TimeSpan& span,
    const std::function<void(const StoredInterval&)>& visit) {
  auto query = database_.prepare(
      fmt::format("SELECT {} FROM interval WHERE meter = ? AND t_start >= ? AND t_start < ? "
                  "ORDER BY t_start, revision",
                  kIntervalColumns));
  if (!query) return tl::unexpected(query.error());
  query->bind(0, std::int64_t{meter}).bind(1, seconds_of(span.begin)).bind(2, seconds_of(span.end));
  std::optional<StoredInterval> last;  // of its start; a later revision may follow
  for (;;) {
    const auto row = query->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) break;
    const StoredInterval next = read_interval(*query, meter);
    if (last && last->reading.start != next.reading.start) visit(*last);
    last = next;
  }
  if (last) visit(*last);
  return {};
}

Result<std::optional<metering::TimeSpan>> SqliteStore::interval_extent(std::uint32_t meter) {
  auto query = database_.prepare("SELECT min(t_start), max(t_start) FROM interval WHERE meter = ?");
  if (!query) return tl::unexpected(query.error());
  const auto row = query->bind(0, std::int64_t{meter}).step();
  if (!row) return tl::unexpected(row.error());
  if (!*row || query->is_null(0)) return std::optional<metering::TimeSpan>{};
  return std::optional{
      metering::TimeSpan{instant_of(query->integer(0)), instant_of(query->integer(1))}};
}

Result<std::vector<RegisterState>> SqliteStore::registers(std::uint32_t meter) {
  auto query = database_.prepare("SELECT state FROM register WHERE meter = ? ORDER BY field");
  if (!query) return tl::unexpected(query.error());
  query->bind(0, std::int64_t{meter});
  std::vector<RegisterState> states;
  for (;;) {
    const auto row = query->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return states;
    auto state = register_from_json(query->text(0));
    if (!state) return tl::unexpected(state.error());
    states.push_back(std::move(*state));
  }
}

Result<std::vector<MeterMonth>> SqliteStore::reopened() {
  auto query = database_.prepare("SELECT meter, month FROM reopened ORDER BY meter, month");
  if (!query) return tl::unexpected(query.error());
  std::vector<MeterMonth> months;
  for (;;) {
    const auto row = query->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return months;
    const auto month = metering::parse_month(query->text(1));
    if (!month) return tl::unexpected(month.error());
    months.push_back({static_cast<std::uint32_t>(query->integer(0)), *month});
  }
}

Result<int> SqliteStore::put_month(std::uint32_t meter, const MonthlyFigure& figure,
                                   const std::string& time_zone_release, Instant now) {
  return database_.transaction([&]() -> Result<int> {
    auto last = database_.prepare(
        "SELECT coalesce(max(revision), -1) FROM month WHERE meter = ? AND month = ?");
    if (!last) return tl::unexpected(last.error());
    const auto row = last->bind(0, std::int64_t{meter})
                         .bind(1, std::string_view{metering::to_string(figure.month)})
                         .step();
    if (!row) return tl::unexpected(row.error());
    const int revision = static_cast<int>(last->integer(0)) + 1;
    last->reset();
    auto insert = database_.prepare(
        "INSERT INTO month VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    if (!insert) return tl::unexpected(insert.error());
    bind_month(*insert, meter, figure, revision, time_zone_release, now);
    if (auto done = insert->run(); !done) return tl::unexpected(done.error());
    auto settled = database_.prepare("DELETE FROM reopened WHERE meter = ? AND month = ?");
    if (!settled) return tl::unexpected(settled.error());
    settled->bind(0, std::int64_t{meter})
        .bind(1, std::string_view{metering::to_string(figure.month)});
    if (auto done = settled->run(); !done) return tl::unexpected(done.error());
    return revision;
  });
}

Result<std::vector<MonthlyFigure>> SqliteStore::months(std::uint32_t meter) {
  auto query = database_.prepare(
      fmt::format("SELECT {} FROM month WHERE meter = ? ORDER BY month, revision", kMonthColumns));
  if (!query) return tl::unexpected(query.error());
  query->bind(0, std::int64_t{meter});
  std::vector<MonthlyFigure> months;
  for (;;) {
    const auto row = query->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return months;
    auto figure = read_month(*query);
    if (!figure) return tl::unexpected(figure.error());
    if (!months.empty() && months.back().month == figure->month) months.pop_back();
    months.push_back(std::move(*figure));
  }
}

Result<std::vector<StoreEvent>> SqliteStore::events(int limit) {
  auto query = database_.prepare(
      "SELECT t, severity, kind, subject, text FROM event ORDER BY t DESC, number DESC LIMIT ?");
  if (!query) return tl::unexpected(query.error());
  query->bind(0, std::int64_t{limit});
  std::vector<StoreEvent> events;
  for (;;) {
    const auto row = query->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return events;
    events.push_back({instant_of(query->integer(0)), static_cast<Severity>(query->integer(1)),
                      query->text(2), query->text(3), query->text(4)});
  }
}

Result<std::int64_t> SqliteStore::add_job(const StoredJob& job) {
  return insert_job(database_, job);
}

Result<void> SqliteStore::put_job(const StoredJob& job) { return update_job(database_, job); }

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

}  // namespace recald::sqlite
