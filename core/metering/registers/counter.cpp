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
constexpr double kJitterSteps = 2.5;   // two: near 1e5 a difference of two is rounded up or down
constexpr std::size_t kErraticRestarts = 10;
constexpr seconds kErraticTime{3600};

/// "v fits X": −2r, and what rounding makes of it, <= v − X <= A since X.
bool fits(const RegisterSample& sample, const RegisterSample& line,
          const CounterSettings& settings) {
  const double rise_kWh = sample.value_kWh - line.value_kWh;
  return rise_kWh >= -kJitterSteps * settings.resolution_kWh &&
         rise_kWh <= rise_max_kWh(sample.time - line.time, settings);
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
  Transition(CounterState state, const RegisterSample& sample, const CounterSettings& settings)
      : sample_{sample}, settings_{settings} {
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
    (void)(no_total() || uncountable() || plain_rise() || jitter() || rollover() ||
           first_contradiction() || agrees_with_pending() || start_pending_again());
    return step_;
  }

 private:
  void believe(const RegisterSample& sample) {
    step_.state.baseline = sample;
    step_.state.phase = CounterPhase::run;
    step_.state.pending.reset();
  }

  /// The read before this one, believed or not.
  [[nodiscard]] const RegisterSample& last() const {
    return step_.state.pending ? step_.state.pending->last : step_.state.baseline;
  }

  bool no_total() {
    if (has_rolled_over()) {
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

  bool jitter() {
    if (rise_kWh_ >= 0.0 || rise_kWh_ < -kJitterSteps * settings_.resolution_kWh) return false;
    step_.bookings.push_back(measured(step_.state.baseline, sample_, 0.0));
    believe({sample_.time, step_.state.baseline.value_kWh});  // so that the dip is not booked again
    return true;
  }

  [[nodiscard]] bool has_rolled_over() const {
    const bool possible = step_.state.phase != CounterPhase::high && rise_kWh_ < 0.0 &&
                          step_.state.baseline.value_kWh > kRolloverFrom * settings_.modulus_kWh;
    const double wrapped_kWh = rise_kWh_ + settings_.modulus_kWh;
    return possible && wrapped_kWh >= 0.0 && wrapped_kWh <= rise_max_kWh_;
  }

  bool rollover() {
    if (!has_rolled_over()) return false;
    const double wrapped_kWh = rise_kWh_ + settings_.modulus_kWh;
    step_.bookings.push_back(measured(step_.state.baseline, sample_, wrapped_kWh));
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
    if (confirmed && !restore_previous()) rebase();
    return true;
  }

  /// The register is back on the abandoned line, so what was booked since was wrong.
  bool restore_previous() {
    const RegisterSample first = step_.state.pending->first;
    if (!is_back() || !fits(first, step_.state.previous->sample, settings_)) return false;
    const RegisterSample left = step_.state.previous->sample;
    step_.bookings.push_back({{left.time, first.time},
                              std::max(0.0, first.value_kWh - left.value_kWh),
                              Validity::scaled,
                              Reason::none,
                              true});
    step_.bookings.push_back(
        measured(first, sample_, std::max(0.0, sample_.value_kWh - first.value_kWh)));
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
    step_.bookings.push_back(
        measured(first, sample_, std::max(0.0, sample_.value_kWh - first.value_kWh)));
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
  CounterStep step_;
  double rise_kWh_ = 0.0;
  double rise_max_kWh_ = 0.0;
};

}  // namespace

double rise_max_kWh(seconds span, const CounterSettings& settings) {
  return kRatedMargin * settings.rated_kW * in_hours(span) + 2.0 * settings.resolution_kWh;
}

CounterStep advance(CounterState state, const RegisterSample& sample,
                    const CounterSettings& settings) {
  assert(settings.rated_kW > 0.0 && settings.resolution_kWh >= 0.0 && settings.modulus_kWh > 0.0);
  assert(state.phase == CounterPhase::empty || sample.time > state.baseline.time);
  return Transition{std::move(state), sample, settings}.run();
}

CounterStep swap_meter(CounterState) { return {{}, {}, CounterEvent::swapped}; }

}  // namespace recald::metering
