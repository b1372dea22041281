#include "core/metering/months/month_closer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/absent.hpp"

namespace recald::metering {
namespace {

using std::chrono::seconds;

constexpr std::size_t kGridsKept = 16;

/// A source's reading, in the terms of a received month.
struct Received {
  double value_kW;
  Validity validity;
};

Received received(const Reading& reading) {
  const bool usable = std::isfinite(reading.mean_kW) && reading.validity != Validity::missing &&
                      reading.validity != Validity::filled;
  if (!usable) return {kAbsent, Validity::missing};
  return {reading.mean_kW, reading.validity};
}

}  // namespace

TimeSpan span_judged_by(const MonthRange& months, const LocalCalendar& calendar) {
  return {calendar.month_span(previous_month(months.first)).begin,
          calendar.month_span(months.last).end + kJudgedAfterwards};
}

MonthCloser::MonthCloser(LocalCalendar calendar, std::vector<Meter> meters, CloserOptions options,
                         Sink sink)
    : calendar_{std::move(calendar)},
      meters_{std::move(meters)},
      options_{std::move(options)},
      sink_{std::move(sink)},
      states_(meters_.size()) {
  assert(options_.months_kept >= 1);
}

void MonthCloser::set_grid(std::uint32_t meter, seconds interval, seconds phase) {
  assert(meter < meters_.size() && states_[meter].records.empty());
  meters_[meter].interval = interval;
  meters_[meter].phase = phase;
}

std::shared_ptr<const MonthGrid> MonthCloser::grid_for(Month month, const Meter& meter) {
  for (const auto& grid : grids_) {
    if (grid->month() == month && grid->interval() == meter.interval &&
        grid->phase() == meter.phase) {
      return grid;
    }
  }
  grids_.push_front(
      std::make_shared<const MonthGrid>(calendar_, month, meter.interval, meter.phase));
  if (grids_.size() > kGridsKept) grids_.pop_back();
  return grids_.front();
}

void MonthCloser::add(const Reading& reading) {
  assert(reading.meter < meters_.size());
  MeterState& state = states_[reading.meter];
  if (state.next_record != nullptr && reading.start == state.next_start) {
    take_newest(state, *state.next_record, state.next_slot, reading);
    return;
  }
  if (reading.start < Instant{} + std::chrono::days{366} ||
      reading.start + meters_[reading.meter].interval >= kLatestInstant) {
    ++state.counts.stray;
    return;
  }
  if (state.newest_end && reading.start > *state.newest_end + options_.leap_max) {
    const bool confirmed = state.held && reading.start > state.held->start;
    if (!confirmed) {
      if (state.held) ++state.counts.stray;
      state.held = reading;
      state.next_record = nullptr;  // the next reading decides about this one first
      return;
    }
    const Reading held = *state.held;
    state.held.reset();
    place(held);
  } else if (state.held) {
    state.held.reset();
    ++state.counts.stray;
  }
  place(reading);
}

void MonthCloser::place(const Reading& reading) {
  MeterState& state = states_[reading.meter];
  if (is_lone_stray(state, reading)) {
    state.records.clear();
    state.next_record = nullptr;
    state.newest_end.reset();
    --state.counts.accepted;
    ++state.counts.stray;
  }
  Record* record = record_for(reading.meter, reading.start);
  if (record == nullptr) {
    ++state.counts.too_late;
    return;
  }
  const auto slot = record->slots.grid->slot_at(reading.start);
  if (!slot) {
    ++state.counts.off_grid;
    return;
  }
  if (state.newest_end && reading.start < *state.newest_end) {
    put(state, *record, static_cast<std::size_t>(*slot), reading);
  } else {
    take_newest(state, *record, static_cast<std::size_t>(*slot), reading);
  }
}

/// Enters a reading that is later than all before it, and closes the months that become due.
void MonthCloser::take_newest(MeterState& state, Record& record, std::size_t slot,
                              const Reading& reading) {
  put(state, record, slot, reading);
  const bool more = slot + 1 < record.slots.measured_kW.size() && !record.closed && !state.held;
  state.next_record = more ? &record : nullptr;
  state.next_slot = slot + 1;
  state.newest_end = state.next_start = reading.start + meters_[reading.meter].interval;
  if (*state.newest_end >= state.next_deadline) close_until(reading.meter, *state.newest_end);
}

/// Whether the very first reading was far ahead by mistake, as the second one shows.
bool MonthCloser::is_lone_stray(const MeterState& state, const Reading& reading) const {
  return state.counts.accepted == 1 && state.newest_end &&
         reading.start + options_.leap_max < *state.newest_end && !options_.period &&
         !state.records.empty() && !state.records.front().closed;
}

void MonthCloser::put(MeterState& state, Record& record, std::size_t slot,
                      const Reading& reading) const {
  MonthSlots& month = record.slots;
  const Received now = received(reading);
  const bool had_value = !std::isnan(month.measured_kW[slot]);
  // What was measured takes the place of its source's own estimate, such as the share of a day.
  const auto is_estimate = [](Validity validity, Reason reasons) {
    return validity == Validity::scaled && has(reasons, Reason::estimated);
  };
  const bool had_estimate = had_value && is_estimate(month.validity[slot], month.reasons[slot]);
  const bool brings_estimate = is_estimate(now.validity, reading.reasons);
  const bool is_same = std::isnan(now.value_kW) || now.value_kW == month.measured_kW[slot];
  if (had_value && (is_same || (brings_estimate && !had_estimate))) {
    ++state.counts.duplicates;
    return;
  }
  if (had_estimate && !brings_estimate && now.validity == Validity::ok) {
    ++state.counts.accepted;
    month.measured_kW[slot] = now.value_kW;
    month.validity[slot] = now.validity;
    month.reasons[slot] = reading.reasons;
  } else if (had_value) {
    ++state.counts.conflicts;
    month.validity[slot] = Validity::suspect;
    month.reasons[slot] |= Reason::mismatch;
  } else {
    ++state.counts.accepted;
    if (reading.reasons != Reason::none) month.reasons[slot] |= reading.reasons;
    if (std::isnan(now.value_kW)) return;  // a blank changes nothing, not even in a closed month
    month.measured_kW[slot] = now.value_kW;
    month.validity[slot] = now.validity;
  }
  if (record.closed) {
    ++state.counts.late;
    record.changed = true;
  }
  if (record.closed || reading.late) month.late[slot] = 1;
}

/// The record whose month contains `start`; creates the months up to it. Null: no longer kept.
MonthCloser::Record* MonthCloser::record_for(std::uint32_t meter, Instant start) {
  MeterState& state = states_[meter];
  if (state.records.empty()) {
    Month month = calendar_.month_of(start);
    if (options_.period) month = std::min(month, options_.period->first);
    append(meter, month);
  }
  while (start >= state.records.back().slots.grid->month_span().end) {
    // Close finished months on the way, so that a long hole does not fill the memory.
    close_until(meter, start);
    append(meter, next_month(state.records.back().slots.grid->month()));
  }
  for (auto record = state.records.rbegin(); record != state.records.rend(); ++record) {
    if (start >= record->slots.grid->month_span().begin) return &*record;
  }
  return prepend_until(meter, start);
}

/// A record may begin unsorted: earlier months can be opened as long as nothing was closed.
MonthCloser::Record* MonthCloser::prepend_until(std::uint32_t meter, Instant start) {
  MeterState& state = states_[meter];
  const Record& front = state.records.front();
  const bool may = front.revision == 0 && !front.closed && !state.handed_out &&
                   start + options_.leap_max >= front.slots.grid->month_span().begin;
  if (!may) return nullptr;
  while (start < state.records.front().slots.grid->month_span().begin) {
    const Month month = previous_month(state.records.front().slots.grid->month());
    state.records.push_front(Record{MonthSlots{grid_for(month, meters_[meter])}});
  }
  set_deadline(state);
  return &state.records.front();
}

void MonthCloser::append(std::uint32_t meter, Month month) {
  MeterState& state = states_[meter];
  state.records.push_back(Record{MonthSlots{grid_for(month, meters_[meter])}});
  set_deadline(state);
}

void MonthCloser::set_deadline(MeterState& state) const {
  state.next_deadline = Instant::max();
  for (const Record& record : state.records) {
    if (record.closed) continue;
    state.next_deadline = record.slots.grid->month_span().end + options_.watermark;
    return;
  }
}

void MonthCloser::close_until(std::uint32_t meter, Instant event_time) {
  MeterState& state = states_[meter];
  if (event_time < state.next_deadline) return;
  hand_out_reopened(meter);
  for (std::size_t i = 0; i < state.records.size(); ++i) {
    const Record& record = state.records[i];
    if (record.closed) continue;
    if (record.slots.grid->month_span().end + options_.watermark > event_time) break;
    hand_out(meter, i);
  }
  forget_old(state);
  set_deadline(state);
}

void MonthCloser::hand_out(std::uint32_t meter, std::size_t index) {
  MeterState& state = states_[meter];
  Record& record = state.records[index];
  ValidationContext context;
  if (index > 0) context.before = &state.records[index - 1].slots;
  if (index + 1 < state.records.size()) context.after = &state.records[index + 1].slots;
  context.largest_believed_kW = state.largest_believed_kW;
  ClosedMonth closed = close_month(meter, record.slots, meters_[meter], context, options_.closing);
  closed.figure.revision = record.revision++;
  record.closed = true;
  record.changed = false;
  if (state.next_record == &record) state.next_record = nullptr;
  state.handed_out = true;
  remember_largest(state, closed.slots);
  sink_(std::move(closed));
}

void MonthCloser::remember_largest(MeterState& state, const MonthSlots& month) {
  double largest_kW = state.largest_believed_kW.value_or(0.0);
  for (std::size_t slot = 0; slot < month.measured_kW.size(); ++slot) {
    if (month.measured_kW[slot] > largest_kW && month.validity[slot] == Validity::ok) {
      largest_kW = month.measured_kW[slot];
    }
  }
  state.largest_believed_kW = largest_kW;
}

void MonthCloser::hand_out_reopened(std::uint32_t meter) {
  MeterState& state = states_[meter];
  for (std::size_t i = 0; i < state.records.size(); ++i) {
    if (state.records[i].changed) hand_out(meter, i);
  }
}

void MonthCloser::forget_old(MeterState& state) const {
  const auto closed = std::count_if(state.records.begin(), state.records.end(),
                                    [](const Record& record) { return record.closed; });
  // Always keep the newest record, which tells the next month.
  for (auto extra = closed - options_.months_kept; extra > 0 && state.records.size() > 1; --extra) {
    if (state.next_record == &state.records.front()) state.next_record = nullptr;
    state.records.pop_front();
  }
}

void MonthCloser::close_due(Instant now) {
  for (std::uint32_t meter = 0; meter < meters_.size(); ++meter) {
    MeterState& state = states_[meter];
    if (state.records.empty()) {
      if (!options_.period) continue;
      append(meter, options_.period->first);
    }
    hand_out_reopened(meter);
    close_until(meter, now);
    for (;;) {  // a silent meter's months are closed too, empty
      const Month next = next_month(state.records.back().slots.grid->month());
      const bool wanted = !options_.period || next <= options_.period->last;
      if (!wanted || calendar_.month_span(next).end + options_.watermark > now) break;
      append(meter, next);
      close_until(meter, now);
    }
  }
}

void MonthCloser::finish() {
  for (std::uint32_t meter = 0; meter < meters_.size(); ++meter) {
    MeterState& state = states_[meter];
    if (state.held) ++state.counts.stray;
    state.held.reset();
    if (state.records.empty() && options_.period) append(meter, options_.period->first);
    if (state.records.empty()) continue;
    hand_out_reopened(meter);
    close_until(meter, Instant::max());
    while (options_.period && state.records.back().slots.grid->month() < options_.period->last) {
      append(meter, next_month(state.records.back().slots.grid->month()));
      close_until(meter, Instant::max());
    }
  }
}

}  // namespace recald::metering
