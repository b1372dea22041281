#include "adapters/sqlite/batch_writer.hpp"

#include <fmt/format.h>

#include <utility>

#include "adapters/sqlite/tables/outbox_table.hpp"
#include "adapters/sqlite/tables/register_json.hpp"
#include "adapters/sqlite/tables/rows.hpp"
#include "adapters/sqlite/tables/tables.hpp"
#include "core/metering/registers/placement.hpp"
#include "core/text/limited.hpp"

namespace recald::sqlite {

using metering::Placement;
using metering::Reading;

struct BatchWriter::Statements {
  Statement newest_interval;
  Statement latest_interval;
  Statement insert_interval;
  Statement insert_outbox_entry;
  Statement put_register;
  Statement insert_sample;
  Statement insert_event;
  Statement count_event;
  Statement reopen_month;
};

BatchWriter::BatchWriter(std::unique_ptr<Statements> statements)
    : statements_(std::move(statements)) {}
BatchWriter::~BatchWriter() = default;
BatchWriter::BatchWriter(BatchWriter&&) noexcept = default;
BatchWriter& BatchWriter::operator=(BatchWriter&&) noexcept = default;

Result<BatchWriter> BatchWriter::prepare(Database& database) {
  auto newest = TRY(database.prepare("SELECT max(t_start) FROM interval WHERE meter = ?"));
  auto latest =
      TRY(database.prepare(fmt::format("SELECT {} FROM interval WHERE meter = ? AND t_start = ? "
                                       "ORDER BY revision DESC LIMIT 1",
                                       kIntervalColumns)));
  auto interval = TRY(database.prepare(insert_into("interval", 8)));
  auto outbox = TRY(database.prepare(insert_outbox_entry()));
  auto state = TRY(database.prepare(insert_into("register", 3, "INSERT OR REPLACE")));
  auto sample = TRY(database.prepare(insert_into("sample", 4, "INSERT OR IGNORE")));
  auto event = database.prepare(
      // Beyond what any destination was told: SQLite gives the number of a deleted row again.
      "INSERT INTO event VALUES (1 + max((SELECT coalesce(max(number), 0) FROM event), "
      "(SELECT coalesce(max(position), 0) FROM cursor WHERE NOT (destination GLOB 'outbox *' OR "
      "destination GLOB 'results of *' OR destination GLOB 'history of *' OR "
      "destination GLOB 'identity for *'))), ?1, ?2, ?3, ?4, ?5, 1, NULL, "
      "row_sum('event', ?1, ?2, ?3, ?4, ?5, 1, NULL))");
  if (!event) return tl::unexpected(event.error());
  auto count = TRY(database.prepare(
      "UPDATE event SET count = count + 1, last = ?1, text = ?2, "
      "sum = row_sum('event', t, severity, kind, subject, ?2, count + 1, ?1) "
      "WHERE number = (SELECT max(number) FROM event WHERE kind = ?3 AND subject = ?4 AND t > ?5) "
      "RETURNING 1"));
  auto reopen = TRY(database.prepare("INSERT OR IGNORE INTO reopened VALUES (?, ?)"));
  return BatchWriter{std::make_unique<Statements>(
      Statements{std::move(newest), std::move(latest), std::move(interval), std::move(outbox),
                 std::move(state), std::move(sample), std::move(*event), std::move(count),
                 std::move(reopen)})};
}

Result<CommitCounts> BatchWriter::write(const StoreBatch& batch) {
  CommitCounts counts;
  TRY(put_intervals(batch, counts));
  TRY(put_registers(batch));
  TRY(put_samples(batch));
  TRY(put_events(batch));
  // Intervals that were already known change no month.
  const bool changes = counts.taken > 0 || batch.intervals.empty();
  TRY(changes ? reopen_months(batch) : Result<void>{});
  return counts;
}

Result<void> BatchWriter::put_intervals(const StoreBatch& batch, CommitCounts& counts) {
  for (const StoreBatch::Interval& interval : batch.intervals) {
    const int before = counts.taken;
    if (auto put = put_interval(interval, batch.edit, counts); !put) return put;
    counts.was_taken.push_back(counts.taken > before);
  }
  return {};
}

Result<std::optional<StoredInterval>> BatchWriter::latest(std::uint32_t meter,
                                                          metering::Instant start) {
  Statement& query = statements_->latest_interval;
  const auto row = TRY(bound(query, meter, start).step());
  if (!row) return std::optional<StoredInterval>{};
  const StoredInterval found = read_interval(Columns{query}, meter);
  query.reset();
  return std::optional{found};
}

Result<bool> BatchWriter::is_newer_than_all(std::uint32_t meter, metering::Instant start) {
  auto known = newest_.find(meter);
  if (known == newest_.end()) {
    Statement& query = statements_->newest_interval;
    TRY(bound(query, meter).step());
    const auto newest = query.is_null(0) ? metering::Instant::min() : instant_of(query.integer(0));
    query.reset();
    known = newest_.emplace(meter, newest).first;
  }
  const bool is_newer = start > known->second;
  if (is_newer) known->second = start;
  return is_newer;
}

Result<void> BatchWriter::put_interval(const StoreBatch::Interval& interval,
                                       const std::optional<std::int64_t>& edit,
                                       CommitCounts& counts) {
  const Reading& reading = interval.reading;
  const auto is_new = TRY(is_newer_than_all(reading.meter, reading.start));
  const auto known =
      TRY(is_new ? Result<std::optional<StoredInterval>>{} : latest(reading.meter, reading.start));
  const std::optional<Reading> known_reading = known ? std::optional{known->reading} : std::nullopt;
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
  const std::int64_t revision = known ? known->revision + 1 : 0;
  TRY(bound(statements_->insert_interval, reading.meter, reading.start, revision, reading.mean_kW,
            reading.validity, reading.late, reading.reasons, edit)
          .run());
  return bound(statements_->insert_outbox_entry, reading.meter, reading.start,
               std::optional<metering::Month>{}, revision)
      .run();
}

Result<void> BatchWriter::put_registers(const StoreBatch& batch) {
  for (const StoreBatch::Register& entry : batch.registers) {
    const std::string state = to_json(entry.state);
    TRY(bound(statements_->put_register, entry.meter, entry.state.field, state).run());
  }
  return {};
}

Result<void> BatchWriter::put_samples(const StoreBatch& batch) {
  for (const RawSample& sample : batch.samples) {
    TRY(bound(statements_->insert_sample, sample.meter, sample.time, sample.field, sample.value)
            .run());
  }
  return {};
}

/// @return whether the event also happened within the last day.
Result<bool> BatchWriter::count_event(const StoreEvent& event) {
  Statement& count = statements_->count_event;
  const auto row = TRY(bound(count, event.time, event.text, event.kind, event.subject,
                             event.time - std::chrono::days{1})
                           .step());
  if (!row) return false;
  TRY(count.run());
  return true;
}

Result<void> BatchWriter::put_events(const StoreBatch& batch) {
  for (const StoreEvent& whole : batch.events) {
    StoreEvent event = whole;
    event.kind = limited(event.kind, kEventWordMax);
    event.subject = limited(event.subject, kEventWordMax);
    event.text = limited(event.text, kEventTextMax);
    const auto counted = TRY(event.is_counted ? count_event(event) : Result<bool>{false});
    if (counted) continue;
    TRY(bound(statements_->insert_event, event.time, event.severity, event.kind, event.subject,
              event.text)
            .run());
  }
  return {};
}

Result<void> BatchWriter::reopen_months(const StoreBatch& batch) {
  for (const MeterMonth& changed : batch.reopened) {
    TRY(bound(statements_->reopen_month, changed.meter, changed.month).run());
  }
  return {};
}

}  // namespace recald::sqlite
