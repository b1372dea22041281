#include <algorithm>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {

EffectKind constant_speed_fans() {
  return {.id = "constant_speed_fans",
          .title = "Fans do not slow down",
          .group = EffectClass::air_system,
          .sentence =
              "Fans run at full speed whenever they run, however little air the rooms ask for: "
              "electricity is high on mild days, and the fans' heat has to be cooled.",
          .strength = {0.0, 1.0, 1.0, "share of the fans that do not slow down"},
          .turns = "fan speed",
          // Drives are in bypass: the boxes throttle, but the fans keep running at full speed.
          .operate = [](const EffectSettings& settings, const Moment&, Operation& operation) {
            operation.air.fan_follows_flow *= std::max(0.0, 1.0 - settings.strength);
          }};
}

}  // namespace recald::simulators
