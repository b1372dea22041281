/// An electricity meter that misses a phase, or counts one backwards.
#include "core/diagnosis/effects/support/alterations.hpp"

namespace recald::diagnosis::effects {

Effect phase_lost() {
  return {
      .id = "phase_lost",
      .title = "Meter has lost or reversed a phase",
      .meaning =
          "From some day on the meter misses a third or two thirds of the electricity: a fuse "
          "of a voltage tap has blown, or a current transformer is mounted backwards.",
      .physics =
          "y x (1 - a) from the date; y recorded power in kW, a = 1/3 one phase lost, "
          "2/3 one reversed or two lost",
      .on_meters =
          "The electricity meter reads a third or two thirds less from one day on; no other "
          "meter changes.",
      .check =
          "The currents of the three phases with a clamp meter, the fuses of the voltage taps "
          "and the direction of the transformers.",
      .effect_class = EffectClass::meter,
      .dating = Dating::must_begin,
      .of_one_meter = true,
      .meter_utilities = {metering::Utility::electricity},
      .confusable = {{"equipment_step",
                      "Chilled water and heat after the date: a lost phase changes neither."},
                     {"scale_fault",
                      "The currents of the three phases, measured with a clamp meter."}},
      // One factor 1 - a covers both faults of three even phases, which the sum cannot distinguish:
      // a = 1/3 one phase lost; 2/3 two lost, or one transformer reversed (1 - 2/3 = 1 - 2 x 1/3);
      // 1 all lost. Phases are rarely even, so values in between are possible; much less than a
      // third is not a phase but a change of load, and the prior excludes it.
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "lost_share",
                 .unit = "-",
                 .prior =
                     TruncatedNormalPrior{.location = 1.0 / 3.0, .sd = 0.1, .min = 0.0, .max = 1.0},
                 .neutral = 0.0,
                 .scan = {1.0 / 3.0, 2.0 / 3.0, 1.0}}};
      },
      .bind =
          [](const SiteFacts&, Values values, int meter) {
            return recording(meter, [lost_share = values[0]](std::span<const DriverHour>,
                                                             std::span<double> power_kW) {
              for (double& value_kW : power_kW) value_kW *= 1.0 - lost_share;
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
