/// Wind presses more air through the envelope than the drawings' leakage area allows.
#include <cmath>

#include "core/absent.hpp"
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {

Effect wind_infiltration() {
  return {
      .id = "wind_infiltration",
      .title = "Wind infiltration",
      .meaning =
          "On windy days much more outdoor air leaks in than the drawings suggest. Look for "
          "open louvres, worn door seals and broken window gaskets.",
      .physics = "infiltration x (1 + k v^n); v wind speed in m/s, k in 1/(m/s)^n, n in -",
      .on_meters = "Heat rises on windy days in cold weather, by day and by night.",
      .check = "Louvres, door seals and window gaskets on the windward side.",
      .effect_class = EffectClass::envelope,
      .dating = Dating::may_begin,
      .needs = {.wind = true},
      .confusable =
          {{"stack_infiltration",
            "Heating on calm, very cold nights: stack draught remains, wind draught does not."},
           {"damper_stuck_open",
            "The outdoor damper position with the fans off, on a calm and on a windy night."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {
            {.name = "wind_factor", .unit = "1/(m/s)^n", .prior = half_normal(0.2), .neutral = 0.0},
            {.name = "wind_exponent",
             .unit = "-",
             .prior = UniformPrior{.min = 0.8, .max = 1.6},
             .neutral = kAbsent,
             .scan = {1.0, 1.33}}};
      },
      .bind =
          [](const SiteFacts&, Values values, int) {
            return operating([factor = values[0], exponent = values[1]](const DriverHour&,
                                                                        StepOperation& operation) {
              operation.infiltration_factor *=
                  1.0 + factor * std::pow(operation.wind_m_s, exponent);
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
