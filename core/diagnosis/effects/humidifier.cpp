/// Steam humidifies dry outdoor air.
#include <algorithm>

#include "core/absent.hpp"
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {

Effect humidifier() {
  return {
      .id = "humidifier",
      .title = "Humidification on demand",
      .meaning =
          "On dry, mostly cold days, steam humidifies the supply air to keep the rooms from drying "
          "out. The drawings show less humidification, or none.",
      .physics =
          "Q [W] = f·ρ V_oa h_fg·max(w_set − w_o, 0), V_oa [m³/s], h_fg [J/kg], w [kg/kg]; f [–] "
          "0…1",
      .on_meters =
          "Heat rises on dry, mostly cold days while the fans run; chilled water stays the same.",
      .check = "The humidifiers in the air handlers, and their set-points.",
      .effect_class = EffectClass::air_system,
      .dating = Dating::may_begin,
      .needs = {.air_system = true, .humidity = true},
      .confusable =
          {{"supply_reset_missing",
            "Chilled water on the same days: humidification does not change it."},
           {"seasonal_hot_water",
            "Days with the same temperature but different humidity: hot water does not depend on "
            "humidity."},
           {"outdoor_air_amount",
            "Cold humid days: outdoor air also costs heat on them, humidification does not."},
           {"stack_infiltration", "Nights with the fans off: no humidifier runs then."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {
            any_share("served_share", "share of the outdoor air"),
            {.name = "held_humidity_ratio",
             .unit = "kg/kg",
             .prior =
                 TruncatedNormalPrior{.location = 0.0055, .sd = 0.0015, .min = 0.002, .max = 0.010},
             .neutral = kAbsent,
             .scan = {0.004, 0.005, 0.006, 0.007}}};
      },
      // The model charges for the humidity above outdoor air, so if only a share of the air
      // handlers has a humidifier, the humidity ratio is lowered accordingly. The larger of this
      // and the drawn humidifier is charged.
      .bind =
          [](const SiteFacts&, Values values, int) {
            return operating([served_share = values[0], held_kg_kg = values[1]](const DriverHour&,
                                                                                StepOperation& op) {
              const double lack_kg_kg =
                  served_share * std::max(held_kg_kg - op.humidity_ratio, 0.0);
              if (lack_kg_kg <= 0.0) return;
              op.humidifier_kg_kg = std::max(op.humidifier_kg_kg, op.humidity_ratio + lack_kg_kg);
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
