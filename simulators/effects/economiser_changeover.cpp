#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {

EffectKind economiser_changeover() {
  return {
      .id = "economiser_changeover",
      .title = "Free cooling ends at the wrong temperature",
      .group = EffectClass::outdoor_air,
      .sentence =
          "The dampers change over at the wrong outdoor temperature: warm humid air is let in "
          "and must be cooled, or free cooling stops too early in mild weather.",
      .strength = {-10.0, -6.0, 10.0, "K that the change-over is too high, negative for too low"},
      .needs = {.cooling_meter = true, .economiser = true},
      .turns = "economiser",
      // The limit above which no extra outdoor air is taken was entered wrongly, or the outdoor
      // sensor reads wrongly. Too high: warm, humid air enters. Too low: free cooling ends early.
      .operate = [](const EffectSettings& settings, const Moment&, Operation& operation) {
        operation.air.economiser_shift_K += settings.strength;
      }};
}

}  // namespace recald::simulators
