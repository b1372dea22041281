#include "adapters/sqlite/refill.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "adapters/sqlite/interval_row.hpp"

namespace recald::sqlite {
namespace {

using metering::Instant;
using metering::TimeSpan;

struct MeterRow {
  std::uint32_t number;
  std::chrono::seconds interval;
};

Result<std::vector<MeterRow>> meters_of(Database& database) {
  auto query = database.prepare("SELECT number, interval_s FROM meter ORDER BY number");
  if (!query) return tl::unexpected(query.error());
  std::vector<MeterRow> meters;
  for (;;) {
    const auto row = query->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return meters;
    meters.push_back(
        {static_cast<std::uint32_t>(query->integer(0)), std::chrono::seconds{query->integer(1)}});
  }
}

/// Where intervals are missing, in order of time.
/// @param next  Start of the first interval that the meter's counter has not booked.
Result<std::vector<TimeSpan>> gaps_of(SqliteStore& store, const MeterRow& meter,
                                      std::optional<Instant> next) {
  std::vector<TimeSpan> gaps;
  std::optional<Instant> expected;
  const auto read = store.for_each_interval(meter.number, {Instant::min(), Instant::max()},
                                            [&](const StoredInterval& interval) {
                                              if (expected && interval.reading.start > *expected) {
                                                gaps.push_back({*expected, interval.reading.start});
                                              }
                                              expected = interval.reading.start + meter.interval;
                                            });
  if (!read) return tl::unexpected(read.error());
  if (expected && next && *expected < *next) gaps.push_back({*expected, *next});
  return gaps;
}

/// What the samples say of the gaps, as a batch.
Result<StoreBatch> batch_for(SqliteStore& store, const MeterRow& meter, const RegisterState& state,
                             const std::vector<TimeSpan>& gaps) {
  std::vector<metering::RegisterSample> samples;
  const auto read = store.for_each_sample(
      meter.number, state.field,
      [&](const metering::RegisterSample& sample) { samples.push_back(sample); });
  if (!read) return tl::unexpected(read.error());
  // The counter remembers the last sample that it believed, which may be lost with its interval.
  const metering::RegisterSample& last = state.counter.baseline;
  if (!samples.empty() && samples.back().time < last.time) samples.push_back(last);
  StoreBatch batch;
  for (const metering::Reading& reading :
       metering::readings_from_register(meter.number, samples, meter.interval, state.settings)) {
    const bool is_lost =
        std::ranges::any_of(gaps, [&](const TimeSpan& gap) { return gap.contains(reading.start); });
    if (is_lost && std::isfinite(reading.mean_kW)) batch.intervals.push_back({reading});
  }
  return batch;
}

}  // namespace

Result<Refilled> refill_intervals(SqliteStore& store) {
  Refilled refilled;
  const auto meters = meters_of(store.database());
  if (!meters) return tl::unexpected(meters.error());
  for (const MeterRow& meter : *meters) {
    // A state that cannot be read says nothing about samples; the daemon begins it anew.
    const auto states = store.registers(meter.number);
    const bool is_known = states && !states->empty();
    const auto gaps = gaps_of(store, meter, is_known ? states->front().book.next : std::nullopt);
    if (!gaps) return tl::unexpected(gaps.error());
    if (gaps->empty()) continue;
    for (const TimeSpan& gap : *gaps) refilled.still_missing += gap.length() / meter.interval;
    if (!is_known) continue;
    const auto batch = batch_for(store, meter, states->front(), *gaps);
    if (!batch) return tl::unexpected(batch.error());
    if (batch->intervals.empty()) continue;
    const auto counts = store.commit(*batch);
    if (!counts) return tl::unexpected(counts.error());
    refilled.from_samples += counts->taken;
    refilled.still_missing -= counts->taken;
  }
  return refilled;
}

}  // namespace recald::sqlite
