/// The plant starts earlier than in its timetable, and earlier still in the cold.
#include <algorithm>

#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/plant_hours.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {

Effect early_start() {
  return {
      .id = "early_start",
      .title = "Early or optimum start",
      .meaning =
          "Fans, heating and cooling start well before the time in the timetable, and even earlier "
          "on cold mornings, so that rooms are comfortable when people arrive.",
      .physics =
          "t_on [h] = t_on,drawn − (Δh_0 + b·max(θ_heat,occ − θ_e, 0)); Δh_0 [h] ≥ 0, "
          "b [h/K] ≥ 0, θ_e outdoor air [°C] of the hour",
      .on_meters =
          "Electricity and heat rise before the timetable says, earlier on colder mornings; the "
          "evening stays the same.",
      .check = "The start time and the optimum-start setting in the building controls.",
      .effect_class = EffectClass::schedule,
      .dating = Dating::may_begin,
      .confusable = {{"thermal_mass",
                      "Fan power before the timetable's start: thermal mass changes only heat, an "
                      "early start also shows in electricity."},
                     {"dst_misapplied",
                      "Whether the evening stop also moved by an hour, and only in summer."},
                     {"clock_offset", "The evening stop: an early start does not change it."},
                     {"night_setback_missing",
                      "The start spike grows with the cold; there is none on weekends without a "
                      "start afterwards."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "lead",
                 .unit = "h",
                 .prior = half_normal(2.0),
                 .neutral = 0.0,
                 .scan = {0.0, 1.0, 3.0}},
                {.name = "lead_per_cold",
                 .unit = "h/K",
                 .prior = half_normal(0.1),
                 .neutral = 0.0,
                 .scan = {0.0, 0.03, 0.1}}};
      },
      .bind =
          [](const SiteFacts&, Values values, int) {
            return operating([fixed_h = values[0], cold_h_K = values[1]](const DriverHour& hour,
                                                                         StepOperation& op) {
              const double cold_K = std::max(op.heating_occupied_C - hour.dry_bulb_C, 0.0);
              run_at_least(covered_share(fixed_h + cold_h_K * cold_K, hour.hours_to_start), op);
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
