/// More or less minimum outdoor air than drawn.
#include "core/diagnosis/effects/support/alterations.hpp"

namespace recald::diagnosis::effects {

Effect outdoor_air_amount() {
  return {
      .id = "outdoor_air_amount",
      .title = "Minimum outdoor air too high or too low",
      .meaning =
          "While the fans run they bring in more, or less, outdoor air than the drawings say, so "
          "more or less air has to be heated, cooled and dehumidified.",
      .physics = "V_oa [m³/s] = V_oa,drawn·(1+a); a [–] −0.9…1.5",
      .on_meters =
          "Heat in cold weather and chilled water in hot weather differ together while the fans "
          "run.",
      .check =
          "The minimum position of the outdoor-air dampers, and the measured outdoor air flow.",
      .effect_class = EffectClass::outdoor_air,
      .dating = Dating::may_begin,
      .confusable =
          {{"demand_ventilation",
            "CO₂ of the return air on busy and on empty days: a wrong amount is wrong on both."},
           {"damper_stuck_open",
            "The damper itself: whether it follows its signal, and whether it closes with the "
            "fans."},
           {"economiser_failed",
            "Compare weather between 8 and 18 °C with hot and cold weather: the minimum amount "
            "matters in hot and cold weather."},
           {"deep_drying", "Heat in winter: outdoor air costs heat too, drying does not."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "change",
                 .unit = "share of the drawn outdoor air",
                 .prior = TruncatedNormalPrior{.location = 0.0, .sd = 0.4, .min = -0.9, .max = 1.5},
                 .neutral = 0.0}};
      },
      .bind =
          [](const SiteFacts&, Values values, int) {
            return operating([change = values[0]](const DriverHour&, StepOperation& op) {
              op.outdoor_air_m3_s *= 1.0 + change;
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
