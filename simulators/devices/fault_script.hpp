/// Faults of simulated meters and when they occur: a short text file that names its disturbance.
///
///     # gateway_one_unit_dead
///     1m..5m   unit 2  silent            # no answer
///     5m..6m   unit 1  late 800ms
///     6m..7m   unit 1  split 30ms        # after the header, and once more in the data
///     7m..8m   unit 1  wrong_unit 9
///     8m..9m   unit 1  wrong_length 40   # in the header
///     9m..10m  unit 1  wrong_count 8     # number of bytes
///     10m..11m unit 1  exception 11
///     11m..12m unit 1  flip 75           # this bit of each reply
///     at 12m   unit 1  reset 0           # the register continues from 0 kWh
///     13m..14m unit 1  register 0        # reads 0 kWh for a while: a bounce
///     15m..16m all     refuse            # the endpoint is down
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace recald::simulators {

enum class DeviceFaultKind : std::uint8_t {
  silent,
  late,
  split,
  wrong_unit,
  wrong_length,
  wrong_count,
  exception,
  flip,
  reset,
  hold,  ///< "register": the counter reads this value.
  refuse,
};

struct ScriptedFault {
  std::chrono::milliseconds begin;  ///< Since the simulation started.
  std::chrono::milliseconds end;    ///< Exclusive; for a reset, the end of time.
  std::optional<int> unit;          ///< Absent: all units.
  DeviceFaultKind kind;
  double amount;  ///< Milliseconds, unit, bytes, code, bit or kWh; 0 if there is none.
};

struct FaultScript {
  std::vector<ScriptedFault> faults;

  /// The active faults of a unit, in order of the file.
  [[nodiscard]] std::vector<ScriptedFault> at(std::chrono::milliseconds t, int unit) const;
};

/// @return the script, or malformed with every wrong line.
[[nodiscard]] Result<FaultScript> parse_fault_script(std::string_view text);

}  // namespace recald::simulators
