#include "adapters/record/ingest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "adapters/record/job_rows.hpp"
#include "adapters/record/schema.hpp"
#include "adapters/record/values.hpp"
#include "core/text/limited.hpp"

namespace recald::record {
namespace {

using metering::Instant;
using postgres::Array;
using postgres::Connection;
using postgres::integer;

/// Beyond it a store's transaction gains nothing.
constexpr std::size_t kIntervalsAtOnce = 5'000;
/// Of one site: four times as many as of the largest that was tried.
constexpr std::int64_t kMetersMax = 10'000;

std::int64_t seconds_of(Instant t) { return t.time_since_epoch().count(); }

Result<void> nothing_or_error(const Result<postgres::Rows>& rows) {
  if (!rows) return tl::unexpected(rows.error());
  return {};
}

/// Intervals of one batch begin in few partitions.
std::map<std::string, Instant> partitions_of(const RecordBatch& batch) {
  std::map<std::string, Instant> found;
  for (const OutboxEntry& entry : batch.entries) {
    const auto* const interval = std::get_if<StoredInterval>(&entry.stored);
    if (interval == nullptr) continue;
    found.emplace(partition_of(interval->reading.start), interval->reading.start);
  }
  return found;
}

/// Takes one batch, within a transaction that somebody else begins and ends; once.
class Taking {
 public:
  Taking(Connection& connection, const std::string& site, const RecordBatch& batch, Instant now)
      : connection_{connection}, site_id_{site}, batch_{batch}, now_{now} {}

  /// Why it stopped without an error of the record.
  enum class End : std::uint8_t { taken, behind, partitions_missing };

  [[nodiscard]] Result<End> run();
  /// Where the outbox's watermark is then.
  [[nodiscard]] const Progress& until() const { return until_; }

 private:
  [[nodiscard]] Result<bool> lock();
  [[nodiscard]] bool is_behind() const;
  /// Of the past only the events and results of before are not told.
  [[nodiscard]] bool may_begin_late() const {
    return batch_.outbox < 0 ? batch_.after.entries == 0 : has_history_;
  }
  [[nodiscard]] Result<void> find_meters();
  [[nodiscard]] Result<void> put_intervals();
  [[nodiscard]] Result<void> put_months();
  [[nodiscard]] Result<void> put_month_jobs();
  [[nodiscard]] Result<void> put_events();
  [[nodiscard]] Result<void> put_results();
  [[nodiscard]] Result<void> put_watermark();

  [[nodiscard]] bool is_new(const OutboxEntry& entry) const {
    return entry.number > known_.entries;
  }
  /// The record's own number of an entry: it goes on over all outboxes of a site, by one for each
  /// entry. What a gateway calls them would not do: its numbers are somebody else's, and may jump.
  /// @param index  In the batch, of a new one.
  [[nodiscard]] std::int64_t seq_of(std::size_t index) const {
    return seq_ + 1 + static_cast<std::int64_t>(index - first_new_);
  }
  [[nodiscard]] std::int64_t meter_of(const OutboxEntry& entry) const {
    return meters_.at({text_of(entry.meter), entry.interval.count()});
  }

  Connection& connection_;
  const std::string& site_id_;
  const RecordBatch& batch_;
  Instant now_;

  std::int64_t site_ = 0;
  bool is_new_outbox_ = false;
  bool has_history_ = false;  ///< All of the past of this outbox was told.
  bool has_partitions_ = true;
  Progress known_;                        ///< The watermark before.
  Progress until_;                        ///< The watermark after.
  std::int64_t seq_ = 0, event_seq_ = 0;  ///< Of the site, before.
  std::size_t first_new_ = 0;             ///< Of the batch's entries, whose numbers rise.
  std::int64_t new_events_ = 0;
  std::map<std::pair<std::string, std::int64_t>, std::int64_t> meters_;
};

/// Nobody else takes anything from the site until the transaction ends.
/// @return false: there is no such site.
Result<bool> Taking::lock() {
  Array partitions;
  for (const auto& [name, start] : partitions_of(batch_)) partitions.add(name);
  // Both rows are read as they are once they are locked. What an outbox said before the record
  // heard of it, it said to others.
  const auto rows = TRY(connection_.run(
      "WITH s AS (UPDATE site SET heard = greatest(heard, $2::timestamptz) "
      "WHERE id = $1 AND retired IS NULL RETURNING number, seq, event_seq) "
      "INSERT INTO source (site, outbox, entries, events, results, begun) "
      "SELECT number, $3, $4, $5, $6, $2::timestamptz FROM s "
      "ON CONFLICT (site, outbox) DO UPDATE SET outbox = excluded.outbox "
      "RETURNING site, entries, events, results, xmax = 0, (SELECT seq FROM s), "
      "(SELECT event_seq FROM s), "
      "(SELECT coalesce(bool_and(to_regclass(p) IS NOT NULL), true) FROM unnest($7::text[]) p), "
      "EXISTS (SELECT FROM source h WHERE h.site = source.site AND h.outbox = -$3::bigint AND "
      "h.entries >= $8)",
      {site_id_, parameter(now_), integer(batch_.outbox), integer(batch_.after.entries),
       integer(batch_.after.events), integer(batch_.after.results), partitions.parameter(),
       integer(kHistorySent)}));
  if (rows.size() == 0) return false;
  site_ = rows.integer(0, 0);
  known_ = {
      .entries = rows.integer(0, 1), .events = rows.integer(0, 2), .results = rows.integer(0, 3)};
  is_new_outbox_ = rows.boolean(0, 4);
  seq_ = rows.integer(0, 5);
  event_seq_ = rows.integer(0, 6);
  has_partitions_ = rows.boolean(0, 7);
  has_history_ = rows.boolean(0, 8);
  return true;
}

Result<Taking::End> Taking::run() {
  const auto is_known = TRY(lock());
  if (!is_known) {
    return failure(
        ErrorCode::not_found,
        fmt::format("the record has no site {}: register it with recald fleet add", site_id_));
  }
  if (is_behind()) {
    if (!is_new_outbox_) until_ = known_;
    return End::behind;
  }
  if (!has_partitions_) return End::partitions_missing;
  const auto beyond = [](std::int64_t known, std::int64_t sent, const auto& rows) {
    return std::max({known, sent, rows.empty() ? 0 : rows.back().number});
  };
  const Progress& after = batch_.after;
  until_ = {.entries = beyond(known_.entries, after.entries, batch_.entries),
            .events = beyond(known_.events, after.events, batch_.events),
            .results = beyond(known_.results, after.results, batch_.results)};
  if (until_ == known_ && !is_new_outbox_) return End::taken;
  const auto first =
      std::ranges::find_if(batch_.entries, [&](const OutboxEntry& one) { return is_new(one); });
  first_new_ = static_cast<std::size_t>(first - batch_.entries.begin());

  auto done = find_meters();
  if (done) done = put_intervals();
  if (done) done = put_months();
  if (done) done = put_events();
  if (done) done = put_results();
  if (done) done = put_watermark();
  if (!done) return tl::unexpected(done.error());
  return End::taken;
}

/// The gateway has forgotten what this record had confirmed, or another that is lost: a backup was
/// restored. Its next rows would hide that. An outbox may begin after its first number only when
/// the past before it was told.
bool Taking::is_behind() const {
  const Progress& after = batch_.after;
  if (is_new_outbox_) return after != Progress{} && !(batch_.is_first && may_begin_late());
  return after.entries > known_.entries || after.events > known_.events ||
         after.results > known_.results;
}

Result<void> Taking::find_meters() {
  std::set<std::pair<std::string, std::int64_t>> wanted;
  for (const OutboxEntry& entry : batch_.entries) {
    const bool is_lost = std::holds_alternative<std::monostate>(entry.stored);
    if (is_new(entry) && !is_lost) wanted.emplace(text_of(entry.meter), entry.interval.count());
  }
  if (wanted.empty()) return {};
  Array asked;
  for (const auto& [id, interval] : wanted) asked.add(id);
  const auto known = TRY(connection_.run(
      "SELECT id, interval_s, number FROM meter WHERE site = $1 AND id = ANY($2::text[])",
      {integer(site_), asked.parameter()}));
  for (int i = 0; i < known.size(); ++i) {
    meters_[{std::string{known.text(i, 0)}, known.integer(i, 1)}] = known.integer(i, 2);
  }
  const bool all_known =
      std::ranges::all_of(wanted, [&](const auto& one) { return meters_.contains(one); });
  if (all_known) return {};
  const auto rows = TRY(connection_.run(
      "SELECT coalesce(max(number), 0) FROM meter WHERE site = $1", {integer(site_)}));
  auto last = rows.integer(0, 0);
  Array ids, intervals, numbers;
  for (const auto& one : wanted) {
    if (!meters_.emplace(one, last + 1).second) continue;
    ids.add(one.first);
    intervals.add(one.second);
    numbers.add(++last);
  }
  if (last > kMetersMax) {
    return failure(ErrorCode::out_of_range,
                   fmt::format("the site would have {} meters in the record, which takes {}; its "
                               "gateway makes up names of meters",
                               last, kMetersMax));
  }
  return nothing_or_error(connection_.run(
      "INSERT INTO meter (site, number, id, interval_s) SELECT $1, * FROM "
      "unnest($2::smallint[], $3::text[], $4::int[])",
      {integer(site_), numbers.parameter(), ids.parameter(), intervals.parameter()}));
}

/// The past may be told again: what says the same as the newest row of its interval is not stored
/// once more.
Result<void> Taking::put_intervals() {
  Array starts, seqs, means, reasons, meters, validities, late;
  bool has_any = false;
  for (std::size_t i = first_new_; i < batch_.entries.size(); ++i) {
    const OutboxEntry& entry = batch_.entries[i];
    const auto* const interval = std::get_if<StoredInterval>(&entry.stored);
    if (interval == nullptr) continue;
    has_any = true;
    const metering::Reading& reading = interval->reading;
    starts.add(seconds_of(reading.start));
    seqs.add(seq_of(i));
    means.add(reading.mean_kW);
    reasons.add(static_cast<std::int64_t>(reading.reasons));
    meters.add(meter_of(entry));
    validities.add(static_cast<std::int64_t>(reading.validity));
    late.add(std::int64_t{reading.late});
  }
  if (!has_any) return {};
  constexpr auto kPast =
      " WHERE NOT EXISTS (SELECT FROM (SELECT * FROM interval i WHERE i.site = $1 AND "
      "i.meter = m AND i.t_start = to_timestamp(t) ORDER BY i.seq DESC LIMIT 1) known WHERE "
      "known.mean_kw IS NOT DISTINCT FROM mean AND known.reasons = r AND known.validity = v AND "
      "known.late = (l <> 0))";
  return nothing_or_error(connection_.run(
      fmt::format("INSERT INTO interval (t_start, seq, mean_kw, site, reasons, meter, validity, "
                  "late) SELECT to_timestamp(t), s, mean, $1, r, m, v, l <> 0 FROM "
                  "unnest($2::bigint[], $3::bigint[], $4::float8[], $5::bigint[], $6::smallint[], "
                  "$7::smallint[], $8::smallint[]) AS u (t, s, mean, r, m, v, l){}",
                  batch_.outbox < 0 ? kPast : ""),
      {integer(site_), starts.parameter(), seqs.parameter(), means.parameter(), reasons.parameter(),
       meters.parameter(), validities.parameter(), late.parameter()}));
}

Result<void> Taking::put_months() {
  Array meters, months, seqs, figures, closed, releases;
  bool has_any = false;
  for (std::size_t i = first_new_; i < batch_.entries.size(); ++i) {
    const OutboxEntry& entry = batch_.entries[i];
    const auto* const month = std::get_if<StoredMonth>(&entry.stored);
    if (month == nullptr) continue;
    has_any = true;
    meters.add(meter_of(entry));
    months.add(metering::to_string(month->figure.month));
    seqs.add(seq_of(i));
    StoredMonth plain = *month;
    plain.figure.unusable_because = text_of(plain.figure.unusable_because);
    plain.time_zone_release = text_of(plain.time_zone_release);
    figures.add(to_json(plain));
    closed.add(seconds_of(month->closed_at));
    releases.add(text_of(month->time_zone_release));
  }
  if (!has_any) return {};
  TRY(connection_.run(
      "INSERT INTO month (site, meter, month, seq, figure, closed_at, time_zone_release) "
      "SELECT $1, m, o, s, f::jsonb, to_timestamp(c), z FROM unnest($2::smallint[], $3::text[], "
      "$4::bigint[], $5::text[], $6::bigint[], $7::text[]) AS u (m, o, s, f, c, z)",
      {integer(site_), meters.parameter(), months.parameter(), seqs.parameter(),
       figures.parameter(), closed.parameter(), releases.parameter()}));
  return put_month_jobs();
}

/// A job for each new figure with which all outputs have a month; none for a figure that says what
/// the one before it said. Each figure counts by itself: had it been the last of its batch, there
/// would be the same jobs. A job is of the newest month that is complete by then, which is what it
/// calculates, whichever month was corrected. A month of which no output can be used changes
/// nothing. A month that has not ended in any time zone comes from a gateway whose clock is wrong.
Result<void> Taking::put_month_jobs() {
  const auto rows = TRY(connection_.run(
      "WITH n AS (SELECT v.number, v.sha256, v.description->>'calibrate_from' AS first_month, "
      "ARRAY(SELECT DISTINCT jsonb_array_elements_text(v.description->'outputs')) AS outputs, "
      "to_char(now() AT TIME ZONE 'UTC' + interval '14 hours', 'YYYY-MM') AS this_month "
      "FROM site s JOIN site_version v ON v.site = s.number AND v.number = s.version "
      "WHERE s.number = $1) "
      "SELECT n.number, n.sha256, c.newest, m.seq, extract(epoch FROM m.closed_at)::bigint "
      "FROM n, month m JOIN meter o ON o.site = m.site AND o.number = m.meter, "
      "LATERAL (SELECT max(month) AS newest, bool_or(month = m.month) AS has_it FROM "
      "(SELECT month FROM (SELECT DISTINCT ON (x.month, x.meter) x.month, p.id, x.figure "
      "FROM month x JOIN meter p ON p.site = x.site AND p.number = x.meter "
      "WHERE x.site = m.site AND x.seq <= m.seq AND x.month < n.this_month AND p.id = "
      "ANY(n.outputs) "
      "ORDER BY x.month, x.meter, x.seq DESC) latest GROUP BY month "
      "HAVING count(DISTINCT id) = cardinality(n.outputs) AND "
      "bool_or((figure->>'usable')::boolean)) complete) c "
      "WHERE m.site = $1 AND m.seq > $2 AND m.month >= n.first_month AND o.id = ANY(n.outputs) "
      "AND c.has_it AND NOT EXISTS (SELECT FROM month q WHERE "
      "q.site = m.site AND q.meter = m.meter AND q.month = m.month AND q.seq = (SELECT max(r.seq) "
      "FROM month r WHERE r.site = m.site AND r.meter = m.meter AND r.month = m.month AND "
      "r.seq < m.seq) AND q.figure - '{closed_at,revision}'::text[] = "
      "m.figure - '{closed_at,revision}'::text[]) ORDER BY m.seq",
      {integer(site_), integer(seq_)}));
  std::vector<NewJob> jobs;
  for (int i = 0; i < rows.size(); ++i) {
    const auto month = TRY(metering::parse_month(rows.text(i, 2)));
    jobs.push_back({.input = {.site = site_id_,
                              .version_sha256 = std::string{rows.text(i, 1)},
                              .month = month,
                              .until_seq = rows.integer(i, 3),
                              .now = instant(rows, i, 4)},
                    .site = site_,
                    .version = static_cast<int>(rows.integer(i, 0)),
                    .asked_by = "month"});
  }
  TRY(put_jobs(connection_, jobs, IfThere::leave));
  return {};
}

Result<void> Taking::put_events() {
  Array numbers, times, severities, kinds, subjects, texts, counts, lasts;
  bool has_any = false;
  for (const StoreEvent& event : batch_.events) {
    if (event.number <= known_.events) continue;
    has_any = true;
    numbers.add(event_seq_ + ++new_events_);
    times.add(seconds_of(event.time));
    severities.add(static_cast<std::int64_t>(event.severity));
    kinds.add(text_of(limited(event.kind, kEventWordMax)));
    subjects.add(text_of(limited(event.subject, kEventWordMax)));
    texts.add(text_of(limited(event.text, kEventTextMax)));
    counts.add(std::int64_t{event.count});
    lasts.add(seconds_of(event.last.value_or(event.time)));
  }
  if (!has_any) return {};
  return nothing_or_error(connection_.run(
      "INSERT INTO event (site, number, time, severity, kind, subject, text, count, last) "
      "SELECT $1, n, to_timestamp(t), v, k, s, x, c, to_timestamp(l) FROM unnest($2::bigint[], "
      "$3::bigint[], $4::smallint[], $5::text[], $6::text[], $7::text[], $8::int[], $9::bigint[]) "
      "AS u (n, t, v, k, s, x, c, l)",
      {integer(site_), numbers.parameter(), times.parameter(), severities.parameter(),
       kinds.parameter(), subjects.parameter(), texts.parameter(), counts.parameter(),
       lasts.parameter()}));
}

/// Of the newest month that the record has: a gateway calculates when a month is closed.
Result<void> Taking::put_results() {
  for (const StoredJob& job : batch_.results) {
    if (job.number <= known_.results) continue;
    const Instant at = job.ended.value_or(job.asked);
    const std::chrono::year_month_day day{std::chrono::floor<std::chrono::days>(at)};
    TRY(connection_.run(
        "INSERT INTO result (site, kind, month, at, accepted, named, message, summary, sha256) "
        "VALUES ($1, $2, coalesce((SELECT max(month) FROM month WHERE site = $1 AND "
        "month <= $3), $3), $4, $5, false, $6, $7, $8)",
        {integer(site_), std::string{recald::name_of(job.kind)},
         metering::to_string(metering::previous_month(day.year() / day.month())), parameter(at),
         job.accepted ? "true" : "false", text_of(job.message), text_of(job.result.document),
         sha256_of(job.result.document)}));
  }
  return {};
}

Result<void> Taking::put_watermark() {
  const bool is_end = until_.entries == kHistorySent;  // which is no row
  const auto rows =
      static_cast<std::int64_t>(batch_.entries.size() - first_new_) - (is_end ? 1 : 0);
  postgres::Parameter newest;
  for (const OutboxEntry& entry : batch_.entries) {
    const auto* const interval = std::get_if<StoredInterval>(&entry.stored);
    if (interval == nullptr || !is_new(entry)) continue;
    const auto start = parameter(interval->reading.start);
    if (!newest || *start > *newest) newest = start;
  }
  return nothing_or_error(connection_.run(
      "WITH w AS (UPDATE source SET entries = $3, events = $4, results = $5 "
      "WHERE site = $1 AND outbox = $2) "
      "UPDATE site SET seq = $6, event_seq = $7, newest = "
      "CASE WHEN newest > now() + interval '1 hour' THEN coalesce($8::timestamptz, newest) "
      "ELSE greatest(newest, $8::timestamptz) END "
      "WHERE number = $1",
      {integer(site_), integer(batch_.outbox), integer(until_.entries), integer(until_.events),
       integer(until_.results), integer(seq_ + std::max<std::int64_t>(rows, 0)),
       integer(event_seq_ + new_events_), newest}));
}

}  // namespace

Result<Watermark> take(Connection& connection, const std::string& site, const RecordBatch& batch,
                       Instant now) {
  for (bool has_partitions = false;;) {
    Watermark watermark{.outbox = batch.outbox, .until = {}, .answers = batch.question};
    auto end = Taking::End::taken;
    const auto done = connection.transaction([&]() -> Result<void> {
      Taking taking{connection, site, batch, now};
      end = TRY(taking.run());
      watermark.until = taking.until();
      if (end != Taking::End::taken) return failure(ErrorCode::cancelled, "");  // rolls back
      return {};
    });
    if (done) return watermark;
    if (done.error().code != ErrorCode::cancelled) return tl::unexpected(done.error());
    if (end != Taking::End::partitions_missing) return watermark;
    if (has_partitions) {
      return failure(ErrorCode::malformed, "the record has lost a partition of its intervals");
    }
    has_partitions = true;
    for (const auto& [name, start] : partitions_of(batch)) {
      TRY(make_partitions(connection, {start, start + std::chrono::seconds{1}}));
    }
  }
}

Result<std::vector<std::pair<std::string, Watermark>>> watermarks(Connection& connection) {
  const auto rows = TRY(connection.run(
      "SELECT DISTINCT ON (t.id) t.id, coalesce(s.outbox, 0), coalesce(s.entries, 0), "
      "coalesce(s.events, 0), coalesce(s.results, 0) "
      "FROM site t LEFT JOIN source s ON s.site = t.number WHERE t.retired IS NULL "
      "ORDER BY t.id, s.number DESC NULLS LAST"));
  std::vector<std::pair<std::string, Watermark>> found;
  for (int i = 0; i < rows.size(); ++i) {
    found.emplace_back(rows.text(i, 0), Watermark{.outbox = rows.integer(i, 1),
                                                  .until = {.entries = rows.integer(i, 2),
                                                            .events = rows.integer(i, 3),
                                                            .results = rows.integer(i, 4)}});
  }
  return found;
}

namespace {

struct RecordedMeter {
  std::int64_t site = 0, number = 0;
  std::string id;
  std::chrono::seconds interval{};
};

/// One of each id: if the same meter came with another interval, the one that came last then.
Result<std::vector<RecordedMeter>> meters_of(Connection& connection, const std::string& site,
                                             std::int64_t until_seq) {
  const auto rows = TRY(connection.run(
      "SELECT site, number, id, interval_s FROM (SELECT DISTINCT ON (m.id) m.* FROM site s "
      "JOIN meter m ON m.site = s.number WHERE s.id = $1 ORDER BY m.id, "
      "CASE WHEN EXISTS (SELECT 1 FROM meter o WHERE o.site = m.site AND o.id = m.id AND "
      "o.number <> m.number) THEN (SELECT max(i.seq) FROM interval i WHERE i.site = m.site AND "
      "i.meter = m.number AND i.seq <= $2) END DESC NULLS LAST) last ORDER BY number",
      {site, integer(until_seq)}));
  std::vector<RecordedMeter> meters;
  for (int i = 0; i < rows.size(); ++i) {
    meters.push_back({.site = rows.integer(i, 0),
                      .number = rows.integer(i, 1),
                      .id = std::string{rows.text(i, 2)},
                      .interval = std::chrono::seconds{rows.integer(i, 3)}});
  }
  return meters;
}

/// Fills a store with the intervals of one meter.
class IntervalCopy {
 public:
  IntervalCopy(Store& store, const RecordedMeter& meter) : store_{store}, meter_{meter} {}

  /// Rows in order of start and seq: the last of a start is the one that counts.
  [[nodiscard]] Result<void> add(const postgres::Rows& row) {
    if (!number_) {
      number_ = TRY(store_.meter_number(meter_.id, meter_.interval));
    }
    const metering::Reading reading{.meter = *number_,
                                    .start = instant(row, 0, 0),
                                    .mean_kW = row.real(0, 1),
                                    .validity = static_cast<metering::Validity>(row.integer(0, 2)),
                                    .reasons = static_cast<metering::Reason>(row.integer(0, 3)),
                                    .late = row.boolean(0, 4)};
    auto& rows = batch_.intervals;
    if (!rows.empty() && rows.back().reading.start == reading.start) {
      rows.back().reading = reading;
      return {};
    }
    if (rows.size() >= kIntervalsAtOnce) {
      if (auto done = commit(); !done) return done;
    }
    rows.push_back({.reading = reading});
    return {};
  }
  [[nodiscard]] Result<void> commit() {
    if (batch_.empty()) return {};
    TRY(store_.commit(batch_));
    batch_.intervals.clear();
    return {};
  }

 private:
  Store& store_;
  const RecordedMeter& meter_;
  std::optional<std::uint32_t> number_;
  StoreBatch batch_;
};

Result<void> copy_intervals(Store& store, Connection& connection, const RecordedMeter& meter,
                            std::int64_t until_seq) {
  IntervalCopy copy{store, meter};
  const auto done = connection.for_each(
      "SELECT extract(epoch FROM t_start)::bigint, mean_kw, validity, reasons, late FROM interval "
      "WHERE site = $1 AND meter = $2 AND seq <= $3 ORDER BY t_start, seq",
      {integer(meter.site), integer(meter.number), integer(until_seq)},
      [&copy](const postgres::Rows& row) { return copy.add(row); });
  return done ? copy.commit() : done;
}

Result<void> copy_months(Store& store, Connection& connection, const RecordedMeter& meter,
                         std::int64_t until_seq) {
  const auto rows = TRY(connection.run(
      "SELECT figure FROM month WHERE site = $1 AND meter = $2 AND seq <= $3 ORDER BY seq",
      {integer(meter.site), integer(meter.number), integer(until_seq)}));
  for (int i = 0; i < rows.size(); ++i) {
    const auto number = TRY(store.meter_number(meter.id, meter.interval));
    const auto month = TRY(parse_stored_month(rows.text(i, 0)));
    TRY(store.put_month(number, month.figure, month.time_zone_release, month.closed_at));
  }
  return {};
}

}  // namespace

Result<void> copy_into(Store& store, Connection& connection, const std::string& site,
                       std::int64_t until_seq) {
  const auto meters = TRY(meters_of(connection, site, until_seq));
  return store.as_one([&]() -> Result<void> {
    for (const RecordedMeter& meter : meters) {
      if (auto done = copy_intervals(store, connection, meter, until_seq); !done) return done;
      if (auto done = copy_months(store, connection, meter, until_seq); !done) return done;
    }
    return {};
  });
}

}  // namespace recald::record
