/// A cumulative register that wraps, bounces, jitters and is reset, turned into booked energy.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/metering/reading.hpp"

namespace recald::metering {

struct CounterSettings {
  double rated_kW;              ///< The most that the load can draw.
  double resolution_kWh = 0.0;  ///< r: step of the register.
  double modulus_kWh = std::numeric_limits<double>::infinity();  ///< M: where it wraps.
};

struct RegisterSample {
  Instant time;
  double value_kWh;  ///< NaN or infinite: a failed read.
  bool operator==(const RegisterSample&) const = default;
};

enum class CounterPhase : std::uint8_t {
  empty,  ///< No baseline yet.
  run,    ///< Last sample believed.
  low,    ///< The register fell, not yet believed.
  high,   ///< The register rose by more than the load can draw, not yet believed.
};

enum class CounterEvent : std::uint8_t { none, bounce, reset, restored, jump, erratic, swapped };

/// Everything that must survive a restart; a plain value.
struct CounterState {
  struct Pending {
    RegisterSample first;
    RegisterSample last;
    int samples;
  };
  /// An outage leaves a register standing at one value, often 0; for as long as it stands it may
  /// come back. A register that counts on its own has probably been reset.
  struct OldBaseline {
    RegisterSample sample;
    Instant expires;  ///< 7 days after the register counted again; `kStands` until then.
  };
  static constexpr Instant kStands = Instant::max();
  CounterPhase phase = CounterPhase::empty;
  RegisterSample baseline{};            ///< B: last sample believed.
  std::optional<OldBaseline> previous;  ///< O: the baseline before the last rebase.
  std::optional<Pending> pending;       ///< P: samples that contradict B.
  std::vector<Instant> restarts;        ///< When P started again within the last hour.
};

/// What one sample settled.
struct CounterBooking {
  TimeSpan span;      ///< (begin, end] in register terms.
  double energy_kWh;  ///< NaN: the span is missing.
  Validity validity;  ///< ok, scaled or missing.
  Reason reasons = Reason::none;
  bool supersedes = false;  ///< Replaces everything booked since `span.begin`.
};

struct CounterStep {
  CounterState state;
  std::vector<CounterBooking> bookings;  ///< None to two, in order of time.
  CounterEvent event = CounterEvent::none;
};

/// One sample through the state machine. Samples come in time order.
///
/// With A = 1.2 rated Δt + 2 r, the most that can have been drawn since a sample: a rise within
/// A is booked; a fall within 2 r is jitter; a fall near the modulus that fits A after adding M is
/// a roll-over; anything else waits until three samples over two minutes agree with each other.
/// Then a fall was a reset (the span up to it is missing, never guessed), a rise a jump.
///
/// If the register returns to the line before the last rebase, that line holds: what was booked
/// since is superseded by the difference, `scaled`. A register that has stood still since then may
/// return after any time, one that counts within 7 days and only over a difference that its load
/// cannot have drawn: counting up through the old value is not a return.
[[nodiscard]] CounterStep advance(CounterState state, const RegisterSample& sample,
                                  const CounterSettings& settings);

/// The device was exchanged (another serial): the next sample is a new baseline.
[[nodiscard]] CounterStep swap_meter(CounterState state);

}  // namespace recald::metering
