#include "adapters/sqlite/recovery/refill.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "adapters/sqlite/tables/rows.hpp"

namespace recald::sqlite {
namespace {

using metering::Instant;
using metering::TimeSpan;

struct MeterRow {
  std::uint32_t number;
  std::chrono::seconds interval;
};

Result<std::vector<MeterRow>> meters_of(Database& database) {
  auto query = TRY(database.prepare("SELECT number, interval_s FROM meter ORDER BY number"));
  return all_rows(query, [](Columns columns) { return MeterRow{columns, columns}; });
}

/// Finds missing intervals, in order of time.
/// @param first  Start of the first interval that ever existed, according to the samples.
/// @param next   Start of the first interval that the meter's counter has not booked.
Result<std::vector<TimeSpan>> gaps_of(SqliteStore& store, const MeterRow& meter,
                                      std::optional<Instant> first, std::optional<Instant> next) {
  std::vector<TimeSpan> gaps;
  std::optional<Instant> expected = first;
  TRY(store.for_each_interval(meter.number, {Instant::min(), Instant::max()},
                              [&](const StoredInterval& interval) {
                                if (expected && interval.reading.start > *expected) {
                                  gaps.push_back({*expected, interval.reading.start});
                                }
                                expected = interval.reading.start + meter.interval;
                              }));
  if (expected && next && *expected < *next) gaps.push_back({*expected, *next});
  return gaps;
}

/// The kept samples of the meter's counter.
Result<std::vector<metering::RegisterSample>> samples_of(SqliteStore& store, const MeterRow& meter,
                                                         const RegisterState& state) {
  std::vector<metering::RegisterSample> samples;
  TRY(store.for_each_sample(meter.number, state.field, [&](const metering::RegisterSample& sample) {
    samples.push_back(sample);
  }));
  // The counter remembers the last sample that it accepted, which may be lost with its interval.
  const metering::RegisterSample& last = state.counter.baseline;
  if (!samples.empty() && samples.back().time < last.time) samples.push_back(last);
  return samples;
}

/// The readings that fill gaps.
StoreBatch batch_for(std::span<const metering::Reading> readings,
                     const std::vector<TimeSpan>& gaps) {
  StoreBatch batch;
  for (const metering::Reading& reading : readings) {
    const bool is_lost =
        std::ranges::any_of(gaps, [&](const TimeSpan& gap) { return gap.contains(reading.start); });
    if (is_lost && std::isfinite(reading.mean_kW)) batch.intervals.push_back({reading});
  }
  return batch;
}

/// The first boundary with a sample before it: no earlier interval can be missing.
Result<std::optional<Instant>> first_boundary(SqliteStore& store, const MeterRow& meter) {
  auto query = TRY(
      store.database().prepare("SELECT (min(t) + ?2 - 1) / ?2 * ?2 FROM sample WHERE meter = ?1"));
  query.bind(0, static_cast<std::int64_t>(meter.number));
  query.bind(1, static_cast<std::int64_t>(meter.interval.count()));
  TRY(query.step());
  if (query.is_null(0)) return std::nullopt;
  return instant_of(query.integer(0));
}

/// Refills one meter and adds up the counts.
Result<void> refill(SqliteStore& store, const MeterRow& meter, Refilled& refilled) {
  // An unreadable state does not affect the samples; the daemon starts it anew.
  const auto states = store.registers(meter.number);
  const RegisterState* state = states && !states->empty() ? &states->front() : nullptr;
  const auto next = state ? state->book.next : std::nullopt;
  const auto begin = TRY(first_boundary(store, meter));
  auto gaps = gaps_of(store, meter, begin, next);
  if (!gaps) return tl::unexpected(gaps.error());
  if (gaps->empty()) return {};

  std::vector<metering::Reading> readings;
  if (state != nullptr) {
    const auto samples = TRY(samples_of(store, meter, *state));
    readings =
        metering::readings_from_register(meter.number, samples, meter.interval, state->settings);
  }
  // If a meter has lost its first intervals, only the samples show where they began.
  const auto first = readings.empty() ? std::nullopt : std::optional{readings.front().start};
  gaps = gaps_of(store, meter, first, next);
  if (!gaps) return tl::unexpected(gaps.error());
  for (const TimeSpan& gap : *gaps) refilled.still_missing += gap.length() / meter.interval;
  const StoreBatch batch = batch_for(readings, *gaps);
  if (batch.intervals.empty()) return {};
  const auto counts = TRY(store.commit(batch));
  refilled.from_samples += counts.taken;
  refilled.still_missing -= counts.taken;
  return {};
}

}  // namespace

Result<Refilled> refill_intervals(SqliteStore& store) {
  Refilled refilled;
  const auto meters = TRY(meters_of(store.database()));
  for (const MeterRow& meter : meters) {
    TRY(refill(store, meter, refilled));
  }
  return refilled;
}

}  // namespace recald::sqlite
