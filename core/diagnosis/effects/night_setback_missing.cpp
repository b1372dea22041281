/// Set-points are not relaxed when the rooms are unoccupied.
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {

Effect night_setback_missing() {
  return {
      .id = "night_setback_missing",
      .title = "Night set-back missing",
      .meaning =
          "Rooms are heated and cooled at night and on weekends almost as during the day: the "
          "thermostats are not set back when everybody has left.",
      .physics =
          "θ_unocc [°C] = θ_unocc,drawn + f·(θ_occ − θ_unocc,drawn), for heating and "
          "cooling; f [–] 0…1, 0: set-back as drawn, 1: none",
      .on_meters =
          "Heat and chilled water stay high at night and on weekends, and the peak of the morning "
          "start is small.",
      .check =
          "The unoccupied set-points in the controls, and a room temperature logger over one "
          "night.",
      .effect_class = EffectClass::schedule,
      .dating = Dating::may_begin,
      .needs = {.night_set_back = true},
      .confusable = {{"damper_stuck_open",
                      "Compare cold calm nights: the load of an open damper also follows the "
                      "humidity, and the morning warm-up spike remains. A room temperature logger "
                      "over one night settles it."},
                     {"thermal_mass",
                      "Room temperature over a weekend: in a heavy building it falls slowly, but "
                      "it falls; without set-back it stays constant."},
                     {"stack_infiltration",
                      "Look for the warm-up spike on Monday morning: with leaks it is there, with "
                      "a missing set-back it is not."},
                     {"after_hours",
                      "Fan power at 02:00: later hours end at some time in the evening, a missing "
                      "set-back lasts until morning and all weekend."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {any_share("missing_share", "share of the set-back")};
      },
      .bind =
          [](const SiteFacts&, Values values, int) {
            return operating([missing_share = values[0]](const DriverHour&, StepOperation& op) {
              op.heating_unoccupied_C +=
                  missing_share * (op.heating_occupied_C - op.heating_unoccupied_C);
              op.cooling_unoccupied_C +=
                  missing_share * (op.cooling_occupied_C - op.cooling_unoccupied_C);
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
