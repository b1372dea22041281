#include "daemon/gateway/ingest/meter_progress.hpp"

#include <algorithm>

namespace recald::daemon {
namespace {

constexpr std::chrono::hours kUsualDays{24 * 31};

}  // namespace

Result<MeterProgress> MeterProgress::open(
    const metering::Meter& meter, const metering::LocalCalendar& calendar, Store& store,
    const std::function<void(const metering::Reading&)>& remember) {
  const auto number = TRY(store.meter_number(meter.id, meter.interval));
  MeterProgress progress{.stored = {number, meter},
                         .open_month = OpenMonth{calendar, meter.interval}};
  const auto extent = TRY(store.interval_extent(number));
  if (extent) {
    const metering::TimeSpan recent{extent->end - kUsualDays, metering::Instant::max()};
    TRY(store.for_each_interval(number, recent, [&](const StoredInterval& stored) {
      if (remember) remember(stored.reading);
      progress.recall(stored.reading);
    }));
  }
  const auto months = TRY(store.months(number));
  if (!months.empty()) {
    progress.closed_until = calendar.month_span(months.back().figure.month).end;
  }
  return progress;
}

void MeterProgress::recall(const metering::Reading& reading) {
  if (!last_interval || reading.start >= last_interval->start) last_interval = reading;
  open_month.observe(reading);
  if (reading.validity != metering::Validity::ok) return;
  const metering::TimeSpan span{reading.start, reading.start + stored.meter.interval};
  if (same_value && span.end <= same_value->end) return;  // late, or corrected
  const bool goes_on = same_value && same_value->end == span.begin &&
                       weather::is_same_value(reading.mean_kW, same_value_is);
  same_value = {goes_on ? same_value->begin : span.begin, span.end};
  same_value_is = reading.mean_kW;
}

void MeterProgress::note(const metering::Reading& reading) {
  recall(reading);
  ++counters.intervals[static_cast<std::size_t>(reading.validity)];
  if (reading.late) ++counters.late;
}

void MeterProgress::mark_late(StoreBatch& batch, const metering::LocalCalendar& calendar) const {
  for (StoreBatch::Interval& interval : batch.intervals) {
    if (interval.reading.start >= closed_until) continue;
    interval.reading.late = true;
    for (const metering::Month month : months_that_depend_on(interval.reading.start, calendar)) {
      const MeterMonth changed{stored.number, month};
      const bool is_closed = calendar.month_span(month).end <= closed_until;
      const bool is_known = std::ranges::find(batch.reopened, changed) != batch.reopened.end();
      if (is_closed && !is_known) batch.reopened.push_back(changed);
    }
  }
}

}  // namespace recald::daemon
