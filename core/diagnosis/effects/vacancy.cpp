/// One long absence of the people.
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/presence.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {

Effect vacancy() {
  return {
      .id = "vacancy",
      .title = "Vacancy",
      .meaning =
          "For some weeks or months much of the building was empty, but the plant kept running.",
      .physics =
          "from t_1 to t_2: people [–] ×(1−a), lights and plugs above their least of the "
          "month [W] ×(1−0.8a); a [–] 0…1",
      .on_meters =
          "Electricity in working hours is lower for some weeks or months, nights stay the same, "
          "heat is higher in winter.",
      .check = "Who moved out and in at those dates, by badges, lift rides or leases.",
      .effect_class = EffectClass::schedule,
      .dating = Dating::window,
      .confusable = {{"equipment_step",
                      "Nights: removed equipment is also missing at night, missing people only "
                      "change working hours. And people come back."},
                     {"semester_calendar",
                      "The second year: term breaks return on the same dates."},
                     {"phase_lost",
                      "Chilled water: a lost phase of the electricity meter does not show there."},
                     {"missing_holidays", "The length: single days or many weeks."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {any_share("absent_share", "share of the people")};
      },
      // The plant keeps its timetable, as mostly in 2020; the wrapper adds the window.
      .bind =
          [](const SiteFacts& facts, Values values, int) {
            return operating([standby = StandbyLoads{facts.drivers}, absent_share = values[0]](
                                 const DriverHour& hour, StepOperation& op) {
              change_presence(-absent_share, standby, hour, op);
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
