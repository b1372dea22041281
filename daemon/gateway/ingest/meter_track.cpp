#include "daemon/gateway/ingest/meter_track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/metering/units.hpp"
#include "daemon/gateway/ingest/read_reasons.hpp"

namespace recald::daemon {
namespace {

using metering::CounterEvent;
using metering::Instant;
using metering::Reason;
using metering::RegisterSample;
using modbus::RegisterField;
using PollTime = std::chrono::sys_time<std::chrono::milliseconds>;

/// The two samples around each interval boundary are kept, and all that the counter doubts. Of a
/// poll a minute the last before a boundary is made up to a period and a half before it
/// (PollTimes).
constexpr std::chrono::seconds kBeforeBoundary{90};
constexpr std::chrono::seconds kAfterBoundary{30};
/// The open interval of a power-only meter is stored this often, so a restart loses no more of it.
constexpr std::chrono::seconds kKeepPowerEvery{60};
/// A synchronised clock never steps back further.
constexpr std::chrono::seconds kClockSlew{2};

/// kW or kWh per unit of the field; maps with other units are refused where they are loaded.
double unit_factor(const RegisterField& field) {
  const auto unit = metering::find_unit(field.unit, metering::Utility::electricity, {});
  assert(unit && "a checked map has known units");
  return unit->factor;
}

Severity severity_of(CounterEvent event) {
  switch (event) {
    case CounterEvent::none:
    case CounterEvent::bounce:
    case CounterEvent::restored:
    case CounterEvent::caught_up:
      return Severity::info;
    case CounterEvent::reset:
    case CounterEvent::jump:
    case CounterEvent::swapped:
    case CounterEvent::erratic:
    case CounterEvent::no_total:
      return Severity::warning;
  }
  assert(false && "every event has a severity");
  return Severity::info;
}

metering::PowerRules power_rules(const metering::BookingRules& booking) {
  return {.interval = booking.interval, .sample_gap_max = booking.sample_gap_max};
}

std::string_view kind_of(CounterEvent event) {
  switch (event) {
    case CounterEvent::none:
      break;
    case CounterEvent::bounce:
      return "counter_bounce";
    case CounterEvent::reset:
      return "counter_reset";
    case CounterEvent::restored:
      return "counter_restored";
    case CounterEvent::jump:
      return "counter_jump";
    case CounterEvent::caught_up:
      return "counter_caught_up";
    case CounterEvent::erratic:
      return "counter_erratic";
    case CounterEvent::no_total:
      return "counter_no_total";
    case CounterEvent::swapped:
      return "meter_swapped";
  }
  return "";
}

}  // namespace

MeterTrack::MeterTrack(TrackedMeter meter, const metering::LocalCalendar& calendar,
                       const std::optional<RegisterState>& restored)
    : meter_(std::move(meter)),
      resets_(reset_times(meter_.counter.resets, calendar)),
      usual_(calendar, meter_.booking.interval),
      refusals_(meter_.id),
      absent_(meter_.id, meter_.booking.sample_gap_max) {
  meter_.map.fields = metered_fields(meter_.map);  // the others are never read
  if (restored) state_ = *restored;
  state_.field = meter_.map.energy.empty() ? "power" : "energy";
  // Use the current settings of the site file; the stored state was reached under the old ones.
  state_.settings = meter_.counter;
  if (meter_.map.energy.size() == 1 && state_.counter.phase == metering::CounterPhase::run) {
    absent_.remember(meter_.map.energy.front(), state_.counter.baseline);
  }
  if (!meter_.map.energy.empty() && meter_.map.power) {
    watch_.emplace(meter_.number, meter_.id, power_rules(meter_.booking));
  }
}

std::optional<Instant> MeterTrack::last_sample() const {
  if (meter_.map.energy.empty()) {
    return state_.power.next ? std::optional{state_.power.until} : std::nullopt;
  }
  if (state_.counter.phase == metering::CounterPhase::empty) return std::nullopt;
  return state_.counter.pending ? state_.counter.pending->last.time : state_.counter.baseline.time;
}

void MeterTrack::clock_was_set() {
  clock_was_set_ = true;
  latest_.clear();
  metering::forget_power(state_.power);
  if (watch_) watch_->clock_was_set();
}

void MeterTrack::note_failure(const modbus::ReadFailure& failure) {
  since_sample_ |= reason_of(failure);
}

void MeterTrack::note_fault(const RegisterField& field, modbus::ValueFault fault) {
  const bool counts = std::ranges::find(meter_.map.energy, field.name) != meter_.map.energy.end();
  const bool is_averaged = meter_.map.energy.empty() && meter_.map.power == field.name;
  if (!counts && !is_averaged) return;
  since_sample_ |= reason_of(fault);
}

StoreBatch MeterTrack::take(const modbus::PlannedRead& read, const modbus::ReadResult& result,
                            PollTime poll, Instant at) {
  StoreBatch batch;
  if (auto event = refusals_.take(read, result, at)) batch.events.push_back(std::move(*event));
  if (!result) {
    note_failure(result.error());
    // A field that could not be read no longer has a current value.
    for (const std::size_t i : read.fields) latest_.erase(meter_.map.fields[i].name);
    update_power();
    return batch;
  }
  live_.read_at = at;
  for (const modbus::FieldValue& found : decode_read(meter_.map.fields, read, *result)) {
    const RegisterField& field = meter_.map.fields[found.field];
    if (const auto value = believed_value(found, at)) {
      latest_[field.name] = {value->value, value->resolution, found.power_of_ten, poll};
    } else {
      latest_.erase(field.name);
      note_fault(field, value.error());
    }
  }
  if (auto event = absent_.take_event()) batch.events.push_back(std::move(*event));
  take_identity(batch, poll, at);
  update_power();
  const auto power_kW = new_power_kW(read);
  if (meter_.map.energy.empty()) {
    if (power_kW) take_power(batch, *power_kW, at);
  } else {
    if (power_kW && watch_) watch_->take_power({at, *power_kW});
    take_energy(batch, poll, at);
    if (watch_) watch_->evaluate(batch, state_.settings, at);
  }
  // Commit intervals together with the state that they were computed from.
  if (!batch.empty() && batch.registers.empty()) batch.registers.push_back({meter_.number, state_});
  return batch;
}

tl::expected<modbus::DecodedValue, modbus::ValueFault> MeterTrack::believed_value(
    const modbus::FieldValue& found, Instant at) {
  const RegisterField& field = meter_.map.fields[found.field];
  const bool counts = std::ranges::find(meter_.map.energy, field.name) != meter_.map.energy.end();
  if (!found.value || !counts) return found.value;
  const double factor = unit_factor(field) * meter_.multiplier;
  if (absent_.believes(field, *found.value, {at, found.value->value * factor}, state_.settings)) {
    return found.value;
  }
  return tl::unexpected(modbus::ValueFault::absent);
}

StoreBatch MeterTrack::take_kept(const RegisterSample& sample) {
  StoreBatch batch;
  take_sample(batch, sample);
  batch.registers.push_back({meter_.number, state_});
  return batch;
}

void MeterTrack::update_power() {
  live_.power_kW.reset();
  if (!meter_.map.power) return;
  const auto found = latest_.find(*meter_.map.power);
  if (found == latest_.end()) return;
  const RegisterField* field = meter_.map.find(*meter_.map.power);
  live_.power_kW = found->second.value * unit_factor(*field) * meter_.multiplier;
}

/// A different serial number twice in a row means another device; once may be a flipped bit.
void MeterTrack::take_identity(StoreBatch& batch, PollTime poll, Instant at) {
  std::string identity;
  for (const std::string& name : meter_.map.identity) {
    const auto found = latest_.find(name);
    if (found == latest_.end() || found->second.poll != poll) return;
    identity += fmt::format("{}{:.0f}", identity.empty() ? "" : "/", found->second.value);
  }
  if (identity.empty() || identity == state_.identity) {
    other_identity_.reset();
    return;
  }
  if (state_.identity.empty()) {
    state_.identity = identity;
    return;
  }
  if (other_identity_ != identity) {
    other_identity_ = identity;
    return;
  }
  batch.events.push_back(
      {at, Severity::warning, std::string{kind_of(CounterEvent::swapped)}, meter_.id,
       fmt::format(
           "meter '{}' is a different device: {} instead of {}; its counter starts again from here",
           meter_.id, identity, state_.identity)});
  state_.identity = identity;
  other_identity_.reset();
  state_.counter = metering::swap_meter(std::move(state_.counter)).state;
}

void MeterTrack::take_energy(StoreBatch& batch, PollTime poll, Instant at) {
  double energy_kWh = 0.0;
  double resolution_kWh = 0.0;
  for (const std::string& name : meter_.map.energy) {
    const auto found = latest_.find(name);
    if (found == latest_.end() || found->second.poll != poll) return;  // the poll is not complete
    const RegisterField* field = meter_.map.find(name);
    const double factor = unit_factor(*field) * meter_.multiplier;
    energy_kWh += found->second.value * factor;
    resolution_kWh += found->second.resolution * factor;
    if (meter_.map.energy.size() > 1) continue;  // each wraps on its own
    const auto modulus = field->modulus ? field->modulus : modbus::wraps_at(field->format);
    state_.settings.digit_kWh = factor;
    if (modulus) {
      state_.settings.modulus_kWh =
          std::min(meter_.counter.modulus_kWh, *modulus * found->second.power_of_ten * factor);
    }
  }
  state_.settings.resolution_kWh = std::max(meter_.counter.resolution_kWh, resolution_kWh);
  for (const std::string& name : meter_.map.energy) latest_.erase(name);
  live_.register_kWh = energy_kWh;
  live_.measured_at = at;
  take_sample(batch, {at, energy_kWh});
}

std::optional<double> MeterTrack::new_power_kW(const modbus::PlannedRead& read) const {
  const bool is_new = std::ranges::any_of(
      read.fields, [&](std::size_t i) { return meter_.map.power == meter_.map.fields[i].name; });
  return is_new ? live_.power_kW : std::nullopt;
}

void MeterTrack::take_power(StoreBatch& batch, double power_kW, Instant at) {
  live_.measured_at = at;
  const bool went_back = state_.power.next && at < state_.power.until - kClockSlew;
  if (std::exchange(clock_was_set_, false) || went_back) {
    since_sample_ |= Reason::clock;
    if (relive_from(at, state_.power.next)) state_.power = {};
  }
  for (const metering::Reading& reading : book_power(state_.power, meter_.number, {at, power_kW},
                                                     since_sample_, power_rules(meter_.booking))) {
    batch.intervals.push_back({reading, is_relived(reading)});
    usual_.observe(reading);
  }
  since_sample_ = Reason::none;
  if (batch.empty() && at - power_kept_ < kKeepPowerEvery) return;
  batch.registers.push_back({meter_.number, state_});
  power_kept_ = at;
}

bool MeterTrack::is_worth_keeping(const RegisterSample& sample) const {
  if (state_.counter.phase != metering::CounterPhase::run) return true;
  const auto past = sample.time.time_since_epoch() % meter_.booking.interval;
  return past < kAfterBoundary || meter_.booking.interval - past <= kBeforeBoundary;
}

/// Times of two clocks cannot be subtracted, so the counter starts anew and the time between is
/// missing. Readings stamped later than now have wrong stamps and will be replaced.
void MeterTrack::begin_anew(Instant now) {
  state_.counter = {};
  since_sample_ |= Reason::clock;
  metering::IntervalBook& book = state_.book;
  if (!book.next || now >= *book.next + meter_.booking.interval) return;
  std::erase_if(book.pieces, [&](const auto& piece) { return piece.span.end > now; });
  if (relive_from(now, book.next)) book = {};
}

/// Intervals before `next` have been stored. @return whether some of them lie in the future.
bool MeterTrack::relive_from(Instant now, std::optional<Instant> next) {
  if (!next || now >= *next) return false;
  relived_until_ = std::max(relived_until_, *next);
  return true;
}

/// A doubtful reading without a value replaces nothing.
bool MeterTrack::is_relived(const metering::Reading& reading) const {
  return reading.start < relived_until_ && std::isfinite(reading.mean_kW);
}

void MeterTrack::take_sample(StoreBatch& batch, const RegisterSample& sample) {
  using metering::CounterPhase;
  const auto last = last_sample();
  if (last && sample.time <= *last && !clock_was_set_) {
    // Two samples in one second. If it is further back, the clock was set while the daemon was off.
    if (*last - sample.time <= kClockSlew) return;
    clock_was_set_ = true;
  }
  if (std::exchange(clock_was_set_, false)) begin_anew(sample.time);

  const metering::CounterState before = state_.counter;
  const auto zeroed = resets_ ? std::optional{resets_(sample.time)} : std::nullopt;
  metering::CounterStep step =
      metering::advance(std::move(state_.counter), sample, state_.settings, zeroed);
  for (metering::CounterBooking& booking : step.bookings) {
    const bool is_hole = booking.span.length() > meter_.booking.sample_gap_max;
    if (is_hole || booking.validity != metering::Validity::ok) booking.reasons |= since_sample_;
  }
  const auto booked =
      book_intervals(state_.book, meter_.number, step, meter_.booking, usual_.shape());
  state_.counter = std::move(step.state);
  for (const metering::BookedInterval& interval : booked) {
    batch.intervals.push_back(
        {interval.reading, interval.supersedes || is_relived(interval.reading)});
    usual_.observe(interval.reading);
    if (watch_) watch_->take_interval(interval.reading);
  }
  if (!step.bookings.empty()) since_sample_ = Reason::none;
  if (step.event != CounterEvent::none) {
    batch.events.push_back(event_of(step.event, sample, before));
  }
  if (step.event != CounterEvent::none || is_worth_keeping(sample)) {
    batch.samples.push_back({meter_.number, state_.field, sample.time, sample.value_kWh});
  }
}

StoreEvent MeterTrack::event_of(CounterEvent event, const RegisterSample& sample,
                                const metering::CounterState& before) const {
  const double from_kWh = before.baseline.value_kWh;
  const auto sentence = [&]() -> std::string {
    switch (event) {
      case CounterEvent::none:
      case CounterEvent::swapped:
        break;
      case CounterEvent::bounce:
        return fmt::format(
            "the register read {:.1f} kWh for a moment and is back at {:.1f}; nothing was lost",
            before.pending->last.value_kWh, sample.value_kWh);
      case CounterEvent::reset:
        return fmt::format(
            "the register fell from {:.1f} to {:.1f} kWh and stays there, so it was reset; the "
            "energy in between is unknown",
            from_kWh, before.pending->first.value_kWh);
      case CounterEvent::jump:
        return fmt::format(
            "the register rose from {:.1f} to {:.1f} kWh, more than a load of {:.0f} kW can use, "
            "and stays there; the rise was not counted",
            from_kWh, before.pending->first.value_kWh, state_.settings.rated_kW);
      case CounterEvent::caught_up:
        return fmt::format(
            "the register was read as {:.1f} kWh since {} and then rose at once to {:.1f}: it had "
            "counted meanwhile, so the rise was distributed over that time",
            from_kWh, metering::to_string(*before.stands_since), before.pending->first.value_kWh);
      case CounterEvent::restored:
        return fmt::format(
            "the register is back at its earlier count, {:.1f} kWh; what was counted in between "
            "was corrected",
            sample.value_kWh);
      case CounterEvent::erratic:
        return fmt::format(
            "the register contradicted itself ten times within an hour, last at "
            "{:.1f} kWh; check the wiring, the register map, or whether rated_kW = "
            "{:.0f} is too low",
            sample.value_kWh, state_.settings.rated_kW);
      case CounterEvent::no_total:
        return fmt::format(
            "the register has gone back {} times since {}, last to {:.4g} kWh, without getting on, "
            "so it is no total (some start again whenever they are read); its intervals since then "
            "do not count. Name the register of the total in its map",
            state_.counter.falls->falls, metering::to_string(state_.counter.falls->before.time),
            sample.value_kWh);
    }
    return "";
  };
  return {sample.time, severity_of(event), std::string{kind_of(event)}, meter_.id,
          fmt::format("meter '{}': {}", meter_.id, sentence())};
}

}  // namespace recald::daemon
