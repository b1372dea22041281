#include "daemon/gateway/recording/known_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "core/text/printable.hpp"

namespace recald::daemon::recording {
namespace {

using metering::Instant;
using metering::Month;
using metering::TimeSpan;

/// A gateway that begins looks at 31 days.
constexpr std::chrono::days kLookedAt{32};
constexpr int kRevisionsMax = 10'000;
constexpr std::chrono::hours kCountedFor{25};
constexpr std::size_t kEventsMax = 1'000;

/// The months that are closed, or will be, of readings that are already there.
std::vector<Month> open_months(const TimeSpan& extent, const metering::LocalCalendar& calendar,
                               std::span<const StoredMonth> closed,
                               std::span<const Month> reopened) {
  std::vector<Month> open;
  for (Month month = calendar.month_of(extent.begin);
       calendar.month_span(month).begin <= extent.end; month = metering::next_month(month)) {
    const bool is_closed = std::ranges::any_of(
        closed, [&](const StoredMonth& one) { return one.figure.month == month; });
    const bool is_reopened = std::ranges::find(reopened, month) != reopened.end();
    if (!is_closed || is_reopened) open.push_back(month);
  }
  return open;
}

Instant known_from(const TimeSpan& extent, const metering::LocalCalendar& calendar,
                   std::span<const Month> open) {
  Instant from = extent.end - kLookedAt;
  if (!open.empty()) {
    from = std::min(from, metering::span_judged_by({open.front(), open.front()}, calendar).begin);
  }
  return from;
}

Result<void> visit_readings(Store& store, const StoredMeter& meter, Instant from,
                            const std::function<void(const Line&)>& visit) {
  Readings some{meter.meter.id, {}};
  TRY(store.for_each_interval(meter.number, {from, Instant::max()}, [&](const StoredInterval& one) {
    some.readings.push_back(one.reading);
    if (some.readings.size() < kReadingsMax) return;
    visit(some);
    some.readings.clear();
  }));
  if (!some.readings.empty()) visit(some);
  return {};
}

/// Events that what happens next is counted with, or told from, in order of their numbers.
Result<std::vector<StoreEvent>> events_to_know(Store& store) {
  const auto silent = TRY(store.silent_meters());
  std::set<std::string> found;
  std::vector<StoreEvent> known;
  std::optional<Instant> newest;
  TRY(store.for_each_event(Instant::max(), [&](const StoreEvent& event) {
    if (!newest) newest = event.time;
    const bool is_recent = event.time >= *newest - kCountedFor && known.size() < kEventsMax;
    const bool is_silence = event.kind == "meter_silent" && silent.contains(event.subject) &&
                            found.insert(event.subject).second;
    if (is_recent || is_silence) known.push_back(event);
    return is_recent || found.size() < silent.size();
  }));
  std::ranges::sort(known, {}, &StoreEvent::number);
  return known;
}

Result<std::uint32_t> number_of(Store& store, const std::string& meter) {
  const auto number = TRY(store.find_meter(meter));
  if (number) return *number;
  return failure(ErrorCode::malformed,
                 fmt::format("no line before describes the meter '{}'", printable(meter)));
}

Result<void> put(Store& store, const KnownMeter& meter) {
  const auto number = TRY(store.meter_number(meter.id, meter.interval));
  if (!meter.rules.empty()) TRY(store.put_closing_rules(number, meter.rules));
  return {};
}

/// As often as it had happened.
Result<void> put(Store& store, const KnownEvent& known) {
  StoreEvent event = known.event;
  TRY(store.commit({.events = {event}}));
  event.is_counted = true;
  event.time = event.last.value_or(event.time);
  const std::vector<StoreEvent> again(static_cast<std::size_t>(event.count - 1), event);
  if (!again.empty()) TRY(store.commit({.events = again}));
  return {};
}

Result<void> put(Store& store, const KnownRegister& known) {
  const auto number = TRY(number_of(store, known.meter));
  TRY(store.commit({.registers = {{number, known.state}}}));
  return {};
}

Result<void> put(Store& store, const Readings& some) {
  const auto number = TRY(number_of(store, some.meter));
  StoreBatch batch;
  for (const metering::Reading& one : some.readings) {
    batch.intervals.push_back({.reading = one, .supersedes = true});
    batch.intervals.back().reading.meter = number;
  }
  TRY(store.commit(batch));
  return {};
}

Result<void> put(Store& store, const KnownMonth& known) {
  const auto number = TRY(number_of(store, known.meter));
  const StoredMonth& month = known.month;
  if (month.figure.revision > kRevisionsMax) {
    return failure(ErrorCode::malformed, "a month has more than 10000 revisions");
  }
  for (int revision = 0; revision <= month.figure.revision; ++revision) {
    TRY(store.put_month(number, month.figure, month.time_zone_release, month.closed_at));
  }
  return {};
}

Result<void> put(Store& store, const ReopenedMonth& known) {
  const auto number = TRY(number_of(store, known.meter));
  TRY(store.commit({.reopened = {{number, known.month}}}));
  return {};
}

Result<void> put(Store&, const auto&) { return {}; }

}  // namespace

Result<void> for_each_known(Store& store, const metering::LocalCalendar& calendar,
                            std::span<const StoredMeter> meters,
                            const std::function<void(const Line&)>& visit) {
  const auto all_reopened = TRY(store.reopened());
  const auto events = TRY(events_to_know(store));
  for (const StoreEvent& event : events) visit(KnownEvent{event});
  for (const StoredMeter& meter : meters) {
    const std::string& id = meter.meter.id;
    KnownMeter known{id, meter.meter.interval, TRY(store.closing_rules(meter.number))};
    const auto extent = TRY(store.interval_extent(meter.number));
    const auto months = TRY(store.months(meter.number));
    std::vector<Month> reopened;
    for (const MeterMonth& one : all_reopened) {
      if (one.meter == meter.number) reopened.push_back(one.month);
    }
    Instant from = Instant::max();
    if (extent) {
      from = known_from(*extent, calendar, open_months(*extent, calendar, months, reopened));
      if (extent->begin < from) known.readings_from = from;
    }
    visit(known);
    if (extent) TRY(visit_readings(store, meter, from, visit));
    // A state that cannot be read is not in use either.
    if (const auto states = store.registers(meter.number)) {
      for (const RegisterState& state : *states) visit(KnownRegister{id, state});
    }
    for (const StoredMonth& month : months) visit(KnownMonth{id, month});
    for (const Month month : reopened) visit(ReopenedMonth{id, month});
  }
  return {};
}

Result<void> put_known(Store& store, const Line& line) {
  return std::visit([&](const auto& one) { return put(store, one); }, line);
}

}  // namespace recald::daemon::recording
