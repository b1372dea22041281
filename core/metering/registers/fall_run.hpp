/// Tells a register that goes back again and again from one that jitters: it is no total.
#pragma once

#include <optional>

#include "core/metering/reading.hpp"

namespace recald::metering {

/// One read of a register.
struct RegisterSample {
  Instant time;
  double value_kWh;  ///< NaN or infinite: a failed read.
  bool operator==(const RegisterSample&) const = default;
};

/// Reads from the first fall of a register on, as long as it does not get on.
struct FallRun {
  RegisterSample before;  ///< The read before the first fall.
  RegisterSample last;
  int samples = 0;          ///< Since `before`.
  int falls = 0;            ///< Reads below the one before them.
  int deep = 0;             ///< Of these, by more than jitter is.
  double cubes_kWh3 = 0.0;  ///< Sum of the cubes of all steps; < 0: it falls in larger ones.
  double sixths_kWh6 = 0.0;
  bool is_no_total = false;  ///< The verdict; stays until the register gets on.
};

/// What a read can show at most: by how much a total rises in that time, and how far it jitters.
struct FallLimits {
  double rise_max_kWh;
  double jitter_kWh;
};

/// Enters one read. The register is no total once it fell ten times in at least an hour, and either
///
/// - each read is one that the load can have counted since the last, and at least every eighth of
///   them falls: it starts again whenever it is read. A total is soon above that; while it is not,
///   it may jitter, and then its highest read rises by more than the jitter.
/// - or it fell by no more than jitter and did not get on, and climbs in smaller steps than it
///   falls. Noise is the same forwards and backwards, so the sum of the cubes of the steps would be
///   0 within its standard error; five of these are asked for, because it is looked at so often.
///
/// A register that stands still never falls. A deep fall from where no load can have brought it
/// since the last read is a failed read, a reset, an exchange or a roll-over, and ends the run.
/// @param run       Nothing before the first fall, and after the register got on.
/// @param previous  The read before; not used while there is a run.
void watch_falls(std::optional<FallRun>& run, const RegisterSample& previous,
                 const RegisterSample& sample, const FallLimits& limits);

}  // namespace recald::metering
