/// The coil dries the air further than drawn.
#include <algorithm>

#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {
namespace {

constexpr double kDriest_kg_kg = 0.003;  // Close to saturated air on freezing coils.

}  // namespace

Effect deep_drying() {
  return {
      .id = "deep_drying",
      .title = "More dehumidification than drawn",
      .meaning =
          "On humid days the cooling coils remove more moisture from the air than the drawings "
          "assume, which costs chilled water.",
      .physics =
          "Q_latent [W] = ρ V_oa h_fg·max(w_o − (w_s − x), 0) while the coil cools, V_oa [m³/s], "
          "h_fg [J/kg], w [kg/kg]; x [kg/kg] ≥ 0; with units in the rooms, of what passes through "
          "their coils",
      .on_meters = "Chilled water rises on humid days only; heat stays the same.",
      .check = "The set-point of the coils' leaving air, and a humidity sensor behind one of them.",
      .effect_class = EffectClass::air_system,
      .dating = Dating::may_begin,
      .needs = {.air_system = true, .humidity = true},
      .confusable =
          {{"economiser_changeover",
            "Humidity at fixed outdoor temperature above 26 °C, where no economiser is open."},
           {"scale_fault",
            "Dry days at the same temperature: a wrong scale is also wrong on them."},
           {"outdoor_air_amount", "Heat in winter: outdoor air costs heat, drying does not."},
           {"fouling",
            "Dry hot days: fouling also costs energy then. A humidity sensor behind the coil "
            "settles it."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "deeper_drying",
                 .unit = "kg/kg",
                 .prior = half_normal(0.0015),
                 .neutral = 0.0}};
      },
      // The catalogue's entry 19 is a latent load missing from the model. This model has a latent
      // load (latent_share 1), so only its depth can be missing: w_s is lower than that of air at
      // 95 % and supply temperature, because the coil is colder than the leaving air.
      .bind =
          [](const SiteFacts&, Values values, int) {
            return operating([deeper_kg_kg = values[0]](const DriverHour&, StepOperation& op) {
              op.coil_humidity_ratio -=
                  std::min(deeper_kg_kg, std::max(op.coil_humidity_ratio - kDriest_kg_kg, 0.0));
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
