/// Effects that a building's drawings do not show, as changes of an EnergyPlus model and of what
/// its schedules say. Names and meanings are those of `simulators/effects`; the physics is
/// EnergyPlus's.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/energyplus/building_year.hpp"

namespace recald::simulators::energyplus {

/// How an effect grows from its first day on.
enum class Course {
  at_once,
  steadily,     ///< By its strength a year.
  sawtooth,     ///< To its strength within a year, then it is put right and begins again.
  for_a_while,  ///< From one day to another.
};

struct HiddenChange {
  std::string_view id;  ///< As `EffectKind`.
  double least;         ///< Strengths that populations draw from; the sign is drawn if `least` < 0.
  double most;
  std::string_view unit;  ///< Empty: the same quantity as `EffectKind`'s.
  bool (*possible)(const BuildingYear& building);
  /// @param rng  The effect's own in this year.
  void (*apply)(BuildingYear& building, double strength, Rng rng);
  Course course = Course::at_once;
  bool dated = false;  ///< Begins on a day; else it has always been there.
};
inline constexpr bool kDated = true;

/// All of them, in order of their names.
[[nodiscard]] const std::vector<HiddenChange>& hidden_changes();

/// Null if there is none of this name: effects in the meters are those of `simulators/effects`.
[[nodiscard]] const HiddenChange* hidden_change(std::string_view id);

}  // namespace recald::simulators::energyplus
