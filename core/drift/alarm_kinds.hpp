/// Of what kind a change is that was found, and what came of it, with their names in documents.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace recald::drift {

/// What an alarm may come from.
enum class CauseKind : std::uint8_t {
  nothing,    ///< A false alarm.
  parameter,  ///< A calibration parameter has another value since.
  direction,  ///< The building moved along a known direction: evenly, unevenly or more and more.
  meter,      ///< One output's figures are multiplied by a factor: the meter, not the building.
  /// An effect that the model lacks: all outputs moved, each by a share of its own, or one alone
  /// and in no month by quite the same share, which a meter's factor is.
  unknown,
  effect,  ///< One that the model lacks, by name.
};

/// What was done about an alarm.
enum class Consequence : std::uint8_t { none, began_anew, meter_set_aside };

/// What is seen in a meter's readings, without any model.
enum class MeterChangeKind : std::uint8_t {
  unit,     ///< It counts in another one: months that are not the building's and have no forecast.
  readings  ///< It gives usable ones for much less of the time; the others are filled.
};

[[nodiscard]] constexpr std::string_view name_of(CauseKind kind) {
  constexpr std::array<std::string_view, 6> kNames{"nothing", "parameter", "use",
                                                   "meter",   "unknown",   "effect"};
  return kNames.at(static_cast<std::size_t>(kind));
}

[[nodiscard]] constexpr std::string_view name_of(Consequence consequence) {
  constexpr std::array<std::string_view, 3> kNames{"none", "began_anew", "meter_set_aside"};
  return kNames.at(static_cast<std::size_t>(consequence));
}

[[nodiscard]] constexpr std::string_view name_of(MeterChangeKind kind) {
  return kind == MeterChangeKind::unit ? "unit" : "readings";
}

}  // namespace recald::drift
