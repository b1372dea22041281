/// Free cooling ends at a different outdoor temperature than drawn.
#include "core/diagnosis/effects/support/alterations.hpp"

namespace recald::diagnosis::effects {

Effect economiser_changeover() {
  return {
      .id = "economiser_changeover",
      .title = "Economiser change-over wrong",
      .meaning =
          "The dampers return to their minimum position at the wrong outdoor temperature: either "
          "free cooling stops too early, or warm and humid air is let in.",
      .physics = "θ_lockout [°C] = θ_lockout,drawn + x; x [K]",
      .on_meters =
          "Chilled water changes within some kelvin of outdoor temperature, near the change-over; "
          "heat hardly changes.",
      .check =
          "The change-over temperature or enthalpy in the controls, and the outdoor sensor that "
          "decides it.",
      .effect_class = EffectClass::outdoor_air,
      .dating = Dating::may_begin,
      .needs = {.air_system = true, .economiser = true},
      .confusable =
          {{"economiser_failed",
            "Chilled water well below the change-over, at 8 to 14 °C: near zero unless the "
            "economiser failed."},
           {"deep_drying",
            "Hours above 26 °C with the same temperature but different humidity, when no "
            "economiser is open."},
           {"solar_gain_change",
            "Compare sunny with cloudy hours at the same outdoor temperature."},
           {"supply_reset_missing",
            "Whether heat rises with chilled water. The damper position at 16 to 26 °C settles "
            "it."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {
            {.name = "shift",
             .unit = "K",
             .prior = TruncatedNormalPrior{.location = 0.0, .sd = 3.0, .min = -10.0, .max = 10.0},
             .neutral = 0.0,
             .scan = {-4.0, -2.0, 2.0, 4.0}}};
      },
      .bind =
          [](const SiteFacts&, Values values, int) {
            return operating([shift_K = values[0]](const DriverHour&, StepOperation& op) {
              op.economiser_lockout_C += shift_K;
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
