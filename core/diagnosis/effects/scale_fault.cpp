/// A meter that counts everything too high or too low.
#include "core/diagnosis/effects/support/alterations.hpp"

namespace recald::diagnosis::effects {

Effect scale_fault() {
  return {
      .id = "scale_fault",
      .title = "Meter's scale is wrong",
      .meaning =
          "The meter reads too high or too low by the same percentage at every hour: a wrong "
          "pulse value, transformer ratio or flow constant.",
      .physics = "y x k; y recorded power in kW, k in -",
      .on_meters =
          "One meter is wrong by the same percentage at every hour; the other meters stay the "
          "same.",
      .check =
          "The pulse value, the transformer ratio or the flow constant, against the meter's "
          "own display.",
      .effect_class = EffectClass::meter,
      .dating = Dating::may_begin,
      .of_one_meter = true,
      .confusable = {{"fouling",
                      "Compare the register with a second meter, in summer and in autumn."},
                     {"night_setback_missing",
                      "The ratio of metered to expected by day and by night: with a wrong "
                      "scale it is the same."},
                     {"phase_lost", "The currents of the three phases."}},
      // Tenfold slips and wrong units are found on arrival of the data; this covers the rest.
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "scale",
                 .unit = "-",
                 .prior = LogNormalPrior{.median = 1.0, .log_sd = 0.1, .min = 0.3, .max = 3.0},
                 .neutral = 1.0}};
      },
      .bind =
          [](const SiteFacts&, Values values, int meter) {
            return recording(meter, [factor = values[0]](std::span<const DriverHour>,
                                                         std::span<double> power_kW) {
              for (double& value_kW : power_kW) value_kW *= factor;
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
