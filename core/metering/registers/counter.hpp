/// Books energy from a cumulative register that wraps, bounces, jitters and is reset.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "core/metering/reading.hpp"
#include "core/metering/registers/fall_run.hpp"

namespace recald::metering {

/// When a register sets itself to zero, by its local clock.
enum class Resets : std::uint8_t { never, daily, monthly };

struct CounterSettings {
  double rated_kW;                                               ///< The largest power of the load.
  double resolution_kWh = 0.0;                                   ///< r: step of the register.
  double modulus_kWh = std::numeric_limits<double>::infinity();  ///< M: where it wraps.
  /// Of one unit that it shows: it may also wrap where its digits end. 0: its digits are unknown.
  double digit_kWh = 0.0;
  bool runs_back = false;  ///< It counts down what is delivered back.
  Resets resets = Resets::never;
};

/// The last instant, at or before `t`, at which a register sets itself to zero. Empty: it never
/// does.
using ResetTimes = std::function<Instant(Instant t)>;

/// Empty where `resets` is never.
[[nodiscard]] ResetTimes reset_times(Resets resets, const LocalCalendar& calendar);

/// A: the most by which the register can have risen in that time.
[[nodiscard]] double rise_max_kWh(std::chrono::seconds span, const CounterSettings& settings);

enum class CounterPhase : std::uint8_t {
  empty,  ///< No baseline yet.
  run,    ///< The last sample was accepted.
  low,    ///< The register fell; not accepted yet.
  high,   ///< The register rose by more than the load can draw; not accepted yet.
};

enum class CounterEvent : std::uint8_t {
  none,
  bounce,
  reset,
  restored,
  jump,
  caught_up,
  erratic,
  no_total,
  swapped
};

/// Everything that must survive a restart; a plain value.
struct CounterState {
  struct Pending {
    RegisterSample first;
    RegisterSample last;
    int samples;
  };
  /// An outage leaves a register at one value, often 0; while it stays there, it may return to its
  /// old line. A register that counts on from there has probably been reset.
  struct OldBaseline {
    RegisterSample sample;
    Instant expires;  ///< 7 days after the register resumed counting; `kStands` until then.
  };
  static constexpr Instant kStands = Instant::max();
  CounterPhase phase = CounterPhase::empty;
  RegisterSample baseline{};            ///< B: last accepted sample.
  std::optional<OldBaseline> previous;  ///< O: the baseline before the last rebase.
  std::optional<Pending> pending;       ///< P: samples that contradict B.
  std::vector<Instant> restarts;        ///< Times when P was restarted within the last hour.
  std::optional<FallRun> falls;         ///< Since the register began to go back again and again.
  std::optional<Instant> stands_since;  ///< When the baseline's value was first read.
};

/// The energy that one sample decides.
struct CounterBooking {
  TimeSpan span;      ///< (begin, end] in register terms.
  double energy_kWh;  ///< NaN: the span is missing.
  Validity validity;  ///< ok, scaled, suspect or missing.
  Reason reasons = Reason::none;
  bool supersedes = false;  ///< Replaces everything booked since `span.begin`.
};

struct CounterStep {
  CounterState state;
  std::vector<CounterBooking> bookings;  ///< None to two, in order of time.
  CounterEvent event = CounterEvent::none;
};

/// Runs one sample through the state machine. Samples come in time order.
///
/// A = 1.2 rated Δt + 2 r is the most that can have been drawn since a sample. A rise within A is
/// booked. A fall within 2 r is jitter. A fall near the modulus that fits A after adding M is a
/// roll-over. Anything else waits until three samples over two minutes agree with each other. Then
/// a fall was a reset (the span up to it is missing, never guessed), and a rise a jump.
///
/// A rise that is too large for the time since the last sample, but not for the time for which the
/// register stood still before, up to 7 days, was counted meanwhile: only what was read stood
/// still. It supersedes that rest, `scaled`.
///
/// A register that is due to be set to zero counts from there: its value is what was used since.
/// What it counted between the last sample and the reset is unknown; over a short time the load is
/// taken to go on, `scaled`, else it is missing.
///
/// If the register returns to the line before the last rebase, that line is valid again: what
/// was booked since is superseded by the difference, `scaled`. A register that has stood still
/// since then may return after any time. One that counts may return within 7 days, and only
/// over a difference that its load cannot have drawn, because counting up through the old value
/// is not a return.
///
/// A register that goes back again and again without getting on is no total (`watch_falls`): what
/// was booked since its first fall is superseded, `suspect`, and what follows is missing until it
/// gets on.
///
/// @param zeroed  When it was last due to be set to zero, at or before the sample; absent: never.
[[nodiscard]] CounterStep advance(CounterState state, const RegisterSample& sample,
                                  const CounterSettings& settings,
                                  std::optional<Instant> zeroed = {});

/// The device was replaced (new serial number): the next sample is a new baseline.
[[nodiscard]] CounterStep swap_meter(CounterState state);

}  // namespace recald::metering
