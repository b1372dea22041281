/// Supply air is colder in mild weather than necessary.
#include <algorithm>

#include "core/absent.hpp"
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {
namespace {

constexpr double kDeepestReset_K = 5.0;  // Usual span of reset controls: 13…18 °C.

}  // namespace

Effect supply_reset_missing() {
  return {
      .id = "supply_reset_missing",
      .title = "Supply-air temperature reset missing",
      .meaning =
          "In mild and cold weather the air handlers keep delivering air as cold as in summer, "
          "which the rooms then have to reheat.",
      .physics =
          "θ_supply [°C] = θ_supply,model − min(k·max(θ_r − θ_e, 0), 5 K); extra cooling and "
          "reheat ≈ ρ c V_min·Δθ_supply [W]; k [K/K] ≥ 0, θ_r [°C]",
      .on_meters =
          "Heat and chilled water rise together in mild and cold weather, and not in hot weather.",
      .check =
          "The reset of the supply-air temperature in the controls, and the supply air over a "
          "week.",
      .effect_class = EffectClass::air_system,
      .dating = Dating::may_begin,
      .needs = {.reheat_boxes = true},
      .confusable =
          {{"simultaneous_heating_cooling",
            "Plot chilled water and heat against outdoor temperature: the effect of a missing "
            "reset stops at a certain temperature, that of leaking valves does not."},
           {"humidifier",
            "Compare dry and humid days at the same outdoor temperature, and chilled water, which "
            "humidification does not change."},
           {"economiser_failed",
            "Heat on the same mild days: only the missing reset raises it. A supply-air sensor "
            "over a week settles it."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {
            {.name = "reset_slope", .unit = "K/K", .prior = half_normal(0.25), .neutral = 0.0},
            {.name = "balance_temperature",
             .unit = "degC",
             .prior = TruncatedNormalPrior{.location = 18.0, .sd = 3.0, .min = 8.0, .max = 28.0},
             .neutral = kAbsent,
             .scan = {14.0, 18.0, 22.0}}};
      },
      // The catalogue adds r·on·(θ_r − θ_e)₊ to the output for chilled water and heat. Here the
      // supply air is made colder and the model does the rest: extra reheat is limited at least
      // flow, free cooling does not use chilled water, and fans move less air. ρ c V_min times this
      // slope is the catalogue's r.
      .bind =
          [](const SiteFacts&, Values values, int) {
            return operating([reset_K_K = values[0], balance_C = values[1]](const DriverHour&,
                                                                            StepOperation& op) {
              const double cold_K = std::max(balance_C - op.dry_bulb_C, 0.0);
              op.supply_C -= std::min(reset_K_K * cold_K, kDeepestReset_K);
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
