#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {

EffectKind setpoint_raised() {
  return {
      .id = "setpoint_raised",
      .title = "Cooling set-point raised",
      .group = EffectClass::operators,
      .sentence =
          "From one date rooms are cooled to a higher temperature (or a lower one): cooling falls "
          "(or rises) whenever it is needed, heating hardly changes.",
      .strength = {-2.0, 1.5, 3.0, "K added to the occupied cooling set-point"},
      .turns = "cooling set-point",
      .dated = true,
      // From one date on, rooms are kept warmer in summer: to save energy, or on request.
      .operate = [](const EffectSettings& settings, const Moment&, Operation& operation) {
        operation.rooms.cooling_C += settings.strength;
      }};
}

}  // namespace recald::simulators
