#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {

EffectKind outdoor_air_amount() {
  return {
      .id = "outdoor_air_amount",
      .title = "Minimum outdoor air changed",
      .group = EffectClass::outdoor_air,
      .sentence =
          "From one date the air handlers take in more outdoor air than designed (or less): "
          "heating in winter and cooling on humid days rise (or fall), mild days hardly change.",
      .strength = {-0.6, 0.5, 1.5, "share added to the designed outdoor air"},
      .turns = "outdoor-air amount",
      .dated = true,
      // Someone changed the minimum damper position: for fresher air, or to save energy.
      .operate = [](const EffectSettings& settings, const Moment&, Operation& operation) {
        operation.air.outdoor_factor *= 1.0 + settings.strength;
      }};
}

}  // namespace recald::simulators
