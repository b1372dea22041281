/// Free cooling does not work.
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {

Effect economiser_failed() {
  return {
      .id = "economiser_failed",
      .title = "Economiser failed or missing",
      .meaning =
          "On mild days chilled water cools the building although cool outdoor air could do it for "
          "free: the dampers do not open beyond their minimum position.",
      .physics = "free-cooling flow [m³/s] ×(1−f); f [–] 0…1, 1: no free cooling",
      .on_meters =
          "Chilled water is used on cool days, when it should be near zero; heat stays the same.",
      .check =
          "The dampers on a dry, cool morning: whether they open beyond their minimum position.",
      .effect_class = EffectClass::outdoor_air,
      .dating = Dating::may_begin,
      .needs = {.air_system = true, .economiser = true},
      .confusable = {{"supply_reset_missing",
                      "Heat on the same days: a failed economiser only costs chilled water, supply "
                      "air that is too cold also costs reheat."},
                     {"economiser_changeover",
                      "The outdoor temperature at which chilled water starts: a wrong change-over "
                      "moves it by a few kelvin, a failure raises all hours below it."},
                     {"solar_gain_change",
                      "Compare cloudy with sunny mild days; or watch the damper position on a dry "
                      "12 °C morning."},
                     {"simultaneous_heating_cooling",
                      "Chilled water at 12 °C with the economiser opened by hand: it falls to near "
                      "zero if the economiser was the cause."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {any_share("failed_share", "share of the free-cooling flow")};
      },
      .bind =
          [](const SiteFacts&, Values values, int) {
            return operating([failed_share = values[0]](const DriverHour&, StepOperation& op) {
              op.economiser_share *= 1.0 - failed_share;
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
