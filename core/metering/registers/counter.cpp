#include "core/metering/registers/counter.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/absent.hpp"

namespace recald::metering {
namespace {

using std::chrono::seconds;

constexpr double kRatedMargin = 1.2;
constexpr int kConfirmSamples = 3;
constexpr seconds kConfirmTime{120};
constexpr seconds kPreviousKept{7 * 86'400};
constexpr double kRolloverFrom = 0.9;  // of the modulus
constexpr double kDigitsMin = 1e4;     // a display has at least four
constexpr double kWrapShare = 0.1;     // of a guessed modulus: more than that any fall would be
constexpr int kTailPerRate = 4;        // times as long as the rate behind the reset was seen
constexpr seconds kTailMax{900};       // before a reset the load goes on for so long
constexpr double kJitterSteps = 2.5;   // two: near 1e5 a difference of two is rounded up or down
constexpr std::size_t kErraticRestarts = 10;
constexpr seconds kErraticTime{3600};

/// "v fits X": −2r, and what rounding makes of it, <= v − X <= A since X.
bool fits(const RegisterSample& sample, const RegisterSample& line,
          const CounterSettings& settings) {
  const double rise_kWh = sample.value_kWh - line.value_kWh;
  const double most_kWh = rise_max_kWh(sample.time - line.time, settings);
  const double least_kWh = settings.runs_back ? -most_kWh : -kJitterSteps * settings.resolution_kWh;
  return rise_kWh >= least_kWh && rise_kWh <= most_kWh;
}

CounterBooking measured(const RegisterSample& from, const RegisterSample& to, double energy_kWh) {
  return {{from.time, to.time}, energy_kWh, Validity::ok};
}

CounterBooking unbooked(Instant from, Instant to, Reason reason) {
  return {{from, to}, kAbsent, Validity::missing, reason};
}

/// One call of `advance`; each branch of the state table is a function that returns
/// whether it applied.
class Transition {
 public:
  Transition(CounterState state, const RegisterSample& sample, const CounterSettings& settings,
             std::optional<Instant> zeroed)
      : sample_{sample}, settings_{settings}, zeroed_{zeroed} {
    step_.state = std::move(state);
    rise_kWh_ = sample.value_kWh - step_.state.baseline.value_kWh;
    rise_max_kWh_ = rise_max_kWh(sample.time - step_.state.baseline.time, settings);
  }

  CounterStep run() {
    if (!std::isfinite(sample_.value_kWh)) return step_;  // the next good sample spans the hole
    if (step_.state.phase == CounterPhase::empty) {
      believe(sample_);
      return step_;
    }
    (void)(due_reset() || no_total() || uncountable() || plain_rise() || counts_down() ||
           jitter() || rollover() || first_contradiction() || agrees_with_pending() ||
           start_pending_again());
    return step_;
  }

 private:
  void believe(const RegisterSample& sample) {
    const bool stands = step_.state.phase != CounterPhase::empty &&
                        sample.value_kWh == step_.state.baseline.value_kWh;
    if (!stands || !step_.state.stands_since) step_.state.stands_since = sample.time;
    step_.state.baseline = sample;
    step_.state.phase = CounterPhase::run;
    step_.state.pending.reset();
  }

  /// The read before this one, believed or not.
  [[nodiscard]] const RegisterSample& last() const {
    return step_.state.pending ? step_.state.pending->last : step_.state.baseline;
  }

  /// Was set to zero, as it is due, and counts from there.
  bool due_reset() {
    const RegisterSample before = step_.state.baseline;
    if (!zeroed_ || *zeroed_ < before.time || sample_.value_kWh < 0.0) return false;
    const seconds since = sample_.time - *zeroed_;
    if (sample_.value_kWh > rise_max_kWh(since, settings_)) return false;
    const bool fell = rise_kWh_ < -kJitterSteps * settings_.resolution_kWh;
    const bool must_have = *zeroed_ > before.time && since > seconds{0} && rise_kWh_ > 0.0;
    if (!fell && !must_have) return false;
    if (*zeroed_ > before.time) book_tail(before, *zeroed_, since);
    if (since > seconds{0}) {
      step_.bookings.push_back(measured({*zeroed_, 0.0}, sample_, sample_.value_kWh));
    }
    step_.state.falls.reset();
    step_.state.previous.reset();
    believe(sample_);
    return true;
  }

  /// What was used after the last sample before a reset.
  void book_tail(const RegisterSample& before, Instant zeroed, seconds since) {
    CounterBooking tail = unbooked(before.time, zeroed, Reason::reset);
    if (tail.span.length() <= std::min(kTailMax, kTailPerRate * since)) {
      tail.energy_kWh = sample_.value_kWh / in_hours(since) * in_hours(tail.span.length());
      tail.validity = Validity::scaled;
    }
    step_.bookings.push_back(tail);
  }

  bool no_total() {
    if (settings_.runs_back) return false;
    if (wrapped_kWh()) {
      step_.state.falls.reset();
      return false;
    }
    std::optional<FallRun>& falls = step_.state.falls;
    const bool was_known = falls && falls->is_no_total;
    const RegisterSample previous = falls ? falls->last : last();
    watch_falls(falls, previous, sample_,
                {.rise_max_kWh = rise_max_kWh(sample_.time - previous.time, settings_),
                 .jitter_kWh = kJitterSteps * settings_.resolution_kWh});
    if (!falls || !falls->is_no_total) return false;
    if (was_known) {
      step_.bookings.push_back(unbooked(step_.state.baseline.time, sample_.time, Reason::reset));
    } else {
      // What was stored as measured is replaced by a doubt: a missing value replaces nothing.
      step_.bookings.push_back(
          {{falls->before.time, sample_.time}, 0.0, Validity::suspect, Reason::reset, true});
      step_.event = CounterEvent::no_total;
    }
    step_.state.previous.reset();
    believe(sample_);
    return true;
  }

  bool uncountable() {
    if (rise_max_kWh_ < settings_.modulus_kWh) return false;
    step_.bookings.push_back(unbooked(step_.state.baseline.time, sample_.time, Reason::wrap));
    believe(sample_);
    return true;
  }

  /// Whether nothing was counted since the old line was abandoned.
  [[nodiscard]] bool stands() const {
    const auto& previous = step_.state.previous;
    return previous && previous->expires == CounterState::kStands;
  }

  /// Whether the sample lies on the abandoned line, and counting does not explain how it got there.
  [[nodiscard]] bool is_back() const {
    const auto& previous = step_.state.previous;
    if (!previous || !fits(sample_, previous->sample, settings_)) return false;
    const double short_kWh = previous->sample.value_kWh - step_.state.baseline.value_kWh;
    // A register that stood still and passes its old value in one step has not counted up to it.
    if (stands()) return std::abs(short_kWh) > 2.0 * settings_.resolution_kWh;
    return sample_.time < previous->expires && short_kWh > rise_max_kWh_;
  }

  bool plain_rise() {
    if (rise_kWh_ < 0.0 || rise_kWh_ > rise_max_kWh_ || (stands() && is_back())) return false;
    if (rise_kWh_ > 0.0 && stands()) step_.state.previous->expires = sample_.time + kPreviousKept;
    CounterBooking booking = measured(step_.state.baseline, sample_, rise_kWh_);
    if (step_.state.pending) {
      booking.reasons = Reason::bounce;
      step_.event = CounterEvent::bounce;
    }
    step_.bookings.push_back(booking);
    believe(sample_);
    return true;
  }

  /// A net register while more is delivered back than used.
  bool counts_down() {
    if (!settings_.runs_back || rise_kWh_ >= 0.0 || -rise_kWh_ > rise_max_kWh_) return false;
    step_.bookings.push_back(measured(step_.state.baseline, sample_, rise_kWh_));
    believe(sample_);
    return true;
  }

  bool jitter() {
    if (rise_kWh_ >= 0.0 || rise_kWh_ < -kJitterSteps * settings_.resolution_kWh) return false;
    step_.bookings.push_back(measured(step_.state.baseline, sample_, 0.0));
    believe({sample_.time, step_.state.baseline.value_kWh});  // so that the dip is not booked again
    return true;
  }

  /// Where the digits of the register end; infinite if they are unknown.
  [[nodiscard]] double digits_end_kWh() const {
    double end_kWh = kDigitsMin * settings_.digit_kWh;
    if (end_kWh <= 0.0) return std::numeric_limits<double>::infinity();
    while (end_kWh <= step_.state.baseline.value_kWh) end_kWh *= 10.0;
    return rise_max_kWh_ <= kWrapShare * end_kWh ? end_kWh
                                                 : std::numeric_limits<double>::infinity();
  }

  /// What was counted, if the register began again behind its largest number.
  [[nodiscard]] std::optional<double> wrapped_kWh() const {
    if (step_.state.phase == CounterPhase::high || rise_kWh_ >= 0.0) return {};
    for (const double modulus_kWh : {settings_.modulus_kWh, digits_end_kWh()}) {
      const double wrapped_kWh = rise_kWh_ + modulus_kWh;
      const bool was_near_end = step_.state.baseline.value_kWh > kRolloverFrom * modulus_kWh;
      if (was_near_end && wrapped_kWh >= 0.0 && wrapped_kWh <= rise_max_kWh_) return wrapped_kWh;
    }
    return {};
  }

  bool rollover() {
    const auto energy_kWh = wrapped_kWh();
    if (!energy_kWh) return false;
    step_.bookings.push_back(measured(step_.state.baseline, sample_, *energy_kWh));
    step_.bookings.back().reasons = Reason::rollover;
    believe(sample_);
    return true;
  }

  void begin_pending() {
    step_.state.phase = rise_kWh_ < 0.0 ? CounterPhase::low : CounterPhase::high;
    step_.state.pending = CounterState::Pending{sample_, sample_, 1};
  }

  bool first_contradiction() {
    if (step_.state.phase != CounterPhase::run) return false;
    begin_pending();
    return true;
  }

  bool agrees_with_pending() {
    CounterState::Pending& pending = *step_.state.pending;
    if (!fits(sample_, pending.last, settings_)) return false;
    ++pending.samples;
    pending.last = sample_;
    const bool confirmed =
        pending.samples >= kConfirmSamples && sample_.time - pending.first.time >= kConfirmTime;
    if (confirmed && !restore_previous() && !catch_up()) rebase();
    return true;
  }

  /// Rises between samples; a counter that jitters has none below zero.
  [[nodiscard]] double rise_between_kWh(const RegisterSample& from,
                                        const RegisterSample& to) const {
    const double rise_kWh = to.value_kWh - from.value_kWh;
    return settings_.runs_back ? rise_kWh : std::max(0.0, rise_kWh);
  }

  /// The register had counted while it was read as standing still.
  bool catch_up() {
    const CounterState& state = step_.state;
    if (state.phase != CounterPhase::high || !state.stands_since) return false;
    const RegisterSample stood{*state.stands_since, state.baseline.value_kWh};
    const RegisterSample first = state.pending->first;
    const bool stood_long = state.baseline.time > stood.time;
    if (!stood_long || first.time - stood.time > kPreviousKept) return false;
    if (!fits(first, stood, settings_)) return false;
    step_.bookings.push_back({{stood.time, first.time},
                              rise_between_kWh(stood, first),
                              Validity::scaled,
                              Reason::none,
                              true});
    step_.bookings.push_back(measured(first, sample_, rise_between_kWh(first, sample_)));
    step_.event = CounterEvent::caught_up;
    believe(sample_);
    return true;
  }

  /// The register is back on the abandoned line, so what was booked since was wrong.
  bool restore_previous() {
    const RegisterSample first = step_.state.pending->first;
    if (!is_back() || !fits(first, step_.state.previous->sample, settings_)) return false;
    const RegisterSample left = step_.state.previous->sample;
    step_.bookings.push_back({{left.time, first.time},
                              rise_between_kWh(left, first),
                              Validity::scaled,
                              Reason::none,
                              true});
    step_.bookings.push_back(measured(first, sample_, rise_between_kWh(first, sample_)));
    step_.event = CounterEvent::restored;
    step_.state.previous.reset();
    believe(sample_);
    return true;
  }

  void rebase() {
    CounterState& state = step_.state;
    const bool fell = state.phase == CounterPhase::low;
    const RegisterSample first = state.pending->first;
    step_.bookings.push_back(
        unbooked(state.baseline.time, first.time, fell ? Reason::reset : Reason::jump));
    step_.bookings.push_back(measured(first, sample_, rise_between_kWh(first, sample_)));
    step_.event = fell ? CounterEvent::reset : CounterEvent::jump;
    const bool counts = sample_.value_kWh != first.value_kWh;
    state.previous = CounterState::OldBaseline{
        state.baseline, counts ? sample_.time + kPreviousKept : CounterState::kStands};
    believe(sample_);
  }

  bool start_pending_again() {
    CounterState& state = step_.state;
    begin_pending();
    state.restarts.push_back(sample_.time);
    std::erase_if(state.restarts, [&](Instant t) { return t <= sample_.time - kErraticTime; });
    if (state.restarts.size() >= kErraticRestarts) {
      step_.event = CounterEvent::erratic;
      state.restarts.clear();
    }
    return true;
  }

  const RegisterSample& sample_;
  const CounterSettings& settings_;
  std::optional<Instant> zeroed_;
  CounterStep step_;
  double rise_kWh_ = 0.0;
  double rise_max_kWh_ = 0.0;
};

}  // namespace

double rise_max_kWh(seconds span, const CounterSettings& settings) {
  return kRatedMargin * settings.rated_kW * in_hours(span) + 2.0 * settings.resolution_kWh;
}

CounterStep advance(CounterState state, const RegisterSample& sample,
                    const CounterSettings& settings, std::optional<Instant> zeroed) {
  assert(settings.rated_kW > 0.0 && settings.resolution_kWh >= 0.0 && settings.modulus_kWh > 0.0);
  assert(state.phase == CounterPhase::empty || sample.time > state.baseline.time);
  return Transition{std::move(state), sample, settings, zeroed}.run();
}

ResetTimes reset_times(Resets resets, const LocalCalendar& calendar) {
  if (resets == Resets::never) return {};
  // Samples come in order of time, so most lie in the span of the one before.
  return [resets, calendar, span = TimeSpan{}](Instant t) mutable {
    if (!span.contains(t)) {
      span = resets == Resets::daily ? calendar.day_span(calendar.local_time(t).date)
                                     : calendar.month_span(calendar.month_of(t));
    }
    return span.begin;
  };
}

CounterStep swap_meter(CounterState) { return {{}, {}, CounterEvent::swapped}; }

}  // namespace recald::metering
