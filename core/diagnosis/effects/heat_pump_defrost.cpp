/// A heat pump heats less efficiently while it defrosts its outdoor coil.
#include <algorithm>
#include <cmath>

#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"
#include "core/weather/psychrometrics.hpp"

namespace recald::diagnosis::effects {
namespace {

// Coils frost most near 1 C: colder air holds less water, and warmer air does not freeze on them.
constexpr double kWorst_C = 1.0;
constexpr double kTwiceVariance_K2 = 18.0;  // 3 K wide
// No frost in air drier than this; full frosting from 90 % on.
constexpr double kDry = 0.5;
constexpr double kDryToMoist = 0.4;

}  // namespace

Effect heat_pump_defrost() {
  return {
      .id = "heat_pump_defrost",
      .title = "Heat pump loses efficiency to frost",
      .meaning =
          "In damp weather around freezing, the heat pump has to defrost its outdoor coil "
          "often and uses more electricity for the same heat.",
      .physics =
          "COP x (1 - d exp(-(T_out - 1 C)^2 / 18 K2) m); m = (RH - 0.5)/0.4 within "
          "0...1, d in -",
      .on_meters =
          "Electricity rises on damp days around freezing, and not in dry or much colder weather.",
      .check = "The outdoor coil and the defrost control, on a damp day around 1 °C.",
      .effect_class = EffectClass::plant,
      .dating = Dating::may_begin,
      .needs = {.humidity = true, .heat_pump = true},
      .confusable =
          {{"humidifier",
            "Compare electricity at 1 °C in damp and in dry weather: frost needs damp air, "
            "humidifiers run in dry air."},
           {"stack_infiltration",
            "Electricity at -10 °C: frost costs nothing then, and draught is at its worst."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "cop_loss",
                 .unit = "-",
                 .prior = half_normal_below(0.15, 0.6),
                 .neutral = 0.0}};
      },
      .bind =
          [](const SiteFacts& facts, Values values, int) {
            return supplying([depth = values[0], pressure_Pa = facts.drivers.pressure_Pa](
                                 const model::Building&, const DriverHour&,
                                 const StepOperation& operation, StepLoads& loads) {
              const double from_worst_K = operation.dry_bulb_C - kWorst_C;
              const double frost = std::exp(-from_worst_K * from_worst_K / kTwiceVariance_K2);
              const double saturated =
                  weather::humidity_ratio(operation.dry_bulb_C, 1.0, pressure_Pa);
              const double moist =
                  std::clamp((operation.humidity_ratio / saturated - kDry) / kDryToMoist, 0.0, 1.0);
              loads.heating_cost_factor /= 1.0 - depth * frost * moist;
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
