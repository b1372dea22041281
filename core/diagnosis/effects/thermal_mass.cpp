/// The building stores more or less heat than typical for its construction.
#include "core/diagnosis/effects/support/alterations.hpp"

namespace recald::diagnosis::effects {

Effect thermal_mass() {
  return {
      .id = "thermal_mass",
      .title = "Building heavier or lighter than drawn",
      .meaning =
          "The building warms and cools more slowly (or faster) than its construction "
          "suggests. Nothing is broken, but start times should take it into account.",
      .physics = "heat capacity C_m x m; C_m in J/(m2 K) of floor area, m in -",
      .on_meters =
          "Heat and cooling follow the outdoor temperature more slowly or faster; over a day they "
          "stay nearly the same.",
      .check =
          "The construction against the drawings, and how room temperature falls over a weekend.",
      .effect_class = EffectClass::envelope,
      .confusable = {{"early_start",
                      "Fan status at dawn: an early start shows there, slow walls do not."},
                     {"night_setback_missing",
                      "Room temperature after a clear night: with a heavy mass it falls "
                      "slowly, with a missing set-back it stays constant."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "mass_factor",
                 .unit = "-",
                 .prior = LogNormalPrior{.median = 1.0, .log_sd = 0.5, .min = 0.2, .max = 5.0},
                 .neutral = 1.0}};
      },
      .bind =
          [](const SiteFacts&, Values values, int) {
            return rebuilding([factor = values[0]](model::Building& building) {
              building.heat_capacity_J_m2K *= factor;
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
