#include <algorithm>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {

EffectKind economiser_failed() {
  return {.id = "economiser_failed",
          .title = "Free cooling does not happen",
          .group = EffectClass::outdoor_air,
          .sentence =
              "The dampers do not open for free cooling in cool weather: chilled water is used in "
              "spring, autumn and winter although outdoor air could cool the building.",
          .strength = {0.0, 1.0, 1.0, "share of the free cooling that is lost"},
          .needs = {.cooling_meter = true, .economiser = true},
          .turns = "economiser",
          // Free cooling is switched off, or some of the air handlers' dampers do not move.
          .operate = [](const EffectSettings& settings, const Moment&, Operation& operation) {
            operation.air.economiser_share *= std::max(0.0, 1.0 - settings.strength);
          }};
}

}  // namespace recald::simulators
