#include <algorithm>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {

EffectKind constant_flow_pumps() {
  return {.id = "constant_flow_pumps",
          .title = "Pumps do not slow down",
          .group = EffectClass::air_system,
          .sentence =
              "Water pumps run at full speed all year, whatever the load: electricity is higher by "
              "a nearly constant amount, most at night and in mild weather.",
          .strength = {0.0, 1.0, 1.0, "share of the pumps that do not slow down"},
          .turns = "pump speed",
          // Pumps set to "hand": full speed day and night, winter and summer.
          .operate = [](const EffectSettings& settings, const Moment&, Operation& operation) {
            operation.plant.pumps_follow_load *= std::max(0.0, 1.0 - settings.strength);
          }};
}

}  // namespace recald::simulators
