/// Outdoor air enters that nobody asked for, while handlers run or while they stand.
#include <algorithm>

#include "core/absent.hpp"
#include "core/diagnosis/effects/support/alterations.hpp"

namespace recald::diagnosis::effects {

Effect damper_stuck_open() {
  return {
      .id = "damper_stuck_open",
      .title = "Outdoor-air damper stuck open",
      .meaning =
          "Cold or humid outdoor air enters through a damper that does not close: too much while "
          "the fans run, or some at night and on weekends through stopped air handlers. Heating "
          "and cooling have to make up for it.",
      .physics =
          "fans on: V_oa [m³/s] ≥ φ·V_supply; or fans off: V_oa = φ·V_oa,day, straight into the "
          "rooms; φ [–] 0…0.9",
      .on_meters =
          "Heat rises in cold weather and chilled water in humid weather, while the fans run or "
          "while they are off.",
      .check =
          "The outdoor-air dampers, by eye: whether each follows its signal and closes when its "
          "fan stops.",
      .effect_class = EffectClass::outdoor_air,
      .dating = Dating::may_begin,
      .needs = {.air_system = true},
      .confusable = {{"outdoor_air_amount",
                      "The damper itself with the fans running: whether it follows its signal."},
                     {"stack_infiltration",
                      "Stop the fans for one cold night with the damper closed by hand: leaks "
                      "remain, the damper's share disappears. Leaks also grow more than linearly "
                      "with the temperature difference."},
                     {"wind_infiltration",
                      "Compare calm with windy nights at the same temperature: the flow through a "
                      "damper hardly depends on the wind."},
                     {"night_setback_missing",
                      "Humid summer nights: outdoor air brings moisture that raises chilled water "
                      "in the morning, set-points do not."},
                     {"ground_coupling",
                      "The delay behind outdoor temperature: heat to the ground lags by weeks, "
                      "outdoor air not at all."},
                     {"round_the_clock_zone", "Fan power at night: an open damper needs none."}},
      // Units in the rooms have no share of outdoor air.
      .parameters = [](const SiteFacts& facts) -> Parameters {
        const bool has_shares = facts.building.air && model::has_reheat_boxes(facts.building);
        return {{.name = "open_share",
                 .unit = "share of the daytime outdoor air, or of the supply air",
                 .prior = UniformPrior{0.0, 0.9},
                 .neutral = 0.0},
                {.name = "while_stopped",
                 .unit = "-",
                 .prior = UniformPrior{0.0, 1.0},
                 .neutral = kAbsent,
                 .scan = has_shares ? std::vector{0.0, 1.0} : std::vector{1.0},
                 .choice = true}};
      },
      // A damper that does not close far enough sets a least share of what a running fan supplies,
      // also while rooms are warmed up. One that does not close at all lets air into stopped
      // handlers; the model itself leaves out rooms that are being served.
      .bind =
          [](const SiteFacts&, Values values, int) {
            return operating([open_share = values[0], is_idle = values[1] > 0.5](
                                 const DriverHour&, StepOperation& op) {
              if (is_idle) {
                op.idle_outdoor_air_m3_s += open_share * op.outdoor_air_m3_s;
              } else {
                op.outdoor_share_min = std::max(op.outdoor_share_min, open_share);
              }
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
