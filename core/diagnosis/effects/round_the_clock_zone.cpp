/// Part of the rooms is served day and night.
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/plant_hours.hpp"

namespace recald::diagnosis::effects {

Effect round_the_clock_zone() {
  return {
      .id = "round_the_clock_zone",
      .title = "Laboratory or other round-the-clock zone",
      .meaning =
          "Part of the building, such as laboratories or a control room, has its fans, "
          "heating and cooling on day and night.",
      .physics =
          "on = max(on, φ) at all hours; φ [–] 0…0.6: share of the rooms drawn as daytime "
          "rooms that keeps its occupied set-points and air flow",
      .on_meters =
          "Electricity, heat and chilled water are higher at night and on weekends, all together.",
      .check =
          "Which rooms have air day and night: laboratories, control rooms, a zone with an "
          "override.",
      .effect_class = EffectClass::schedule,
      .dating = Dating::may_begin,
      .confusable =
          {{"server_room",
            "Heat on cold nights: a server room saves heat, a ventilated zone costs it."},
           {"damper_stuck_open", "Fan power at night: an open damper lets air in without any fan."},
           {"night_setback_missing",
            "Electricity at night: set-points alone hardly change it, running fans do."},
           {"constant_flow_pumps",
            "Whether the extra electricity at night also shows in chilled water and heat."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "floor_share",
                 .unit = "share of the daytime rooms",
                 .prior = UniformPrior{0.0, 0.6},
                 .neutral = 0.0}};
      },
      // The rooms' own electricity is already in the meter's profile; only air and set-points
      // change.
      .bind =
          [](const SiteFacts&, Values values, int) {
            return operating([floor_share = values[0]](const DriverHour&, StepOperation& op) {
              run_at_least(floor_share, op);
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
