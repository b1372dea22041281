/// Fans do not slow down with the flow.
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {

Effect constant_speed_fans() {
  return {
      .id = "constant_speed_fans",
      .title = "Fans at constant speed",
      .meaning =
          "The fans always run at full power, although the boxes need less air: speed drives are "
          "missing, bypassed or locked.",
      .physics = "fan power share g(r) ← (1−f)·g(r) + f, r flow over design flow [–]; f [–] 0…1",
      .on_meters =
          "Electricity is flat while the plant runs, and higher on mild days; heat and chilled "
          "water hardly change.",
      .check = "The fans' speed drives: bypassed, locked by hand, or missing.",
      .effect_class = EffectClass::air_system,
      .dating = Dating::may_begin,
      .needs = {.reheat_boxes = true},
      .confusable = {{"demand_limit",
                      "Hot afternoons: constant fans are flat on all days, a demand limit only "
                      "cuts the peaks."},
                     {"weekend_operation", "Fan power on Saturdays and Sundays."},
                     {"constant_flow_pumps", "Electricity at night with the fans off."},
                     {"equipment_step",
                      "Electricity plotted against chilled water at a fixed hour: with constant "
                      "fans there is no slope. A clamp meter on one fan settles it."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {any_share("constant_share", "share of the fans")};
      },
      .bind =
          [](const SiteFacts&, Values values, int) {
            return operating([constant_share = values[0]](const DriverHour&, StepOperation& op) {
              op.constant_fan_share += constant_share * (1.0 - op.constant_fan_share);
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
