/// Outdoor air follows the number of people.
#include <algorithm>

#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {
namespace {

/// All handlers together if all run round the clock: then they serve ordinary rooms.
double always_share(const model::Building& building) {
  const double share = building.air ? building.air->outdoor_air_unoccupied_fraction : 0.0;
  return share < 1.0 ? share : 0.0;
}

}  // namespace

Effect demand_ventilation() {
  return {
      .id = "demand_ventilation",
      .title = "Demand-controlled ventilation",
      .meaning =
          "The amount of outdoor air follows the number of people, through CO₂ sensors for "
          "instance; the model has a constant amount whenever the fans run.",
      .physics =
          "V_oa [m³/s] = V_oa,drawn·((1−b) + b·occ), occ people present [–] 0…1, b [–] 0…1, in "
          "handlers of daytime rooms",
      .on_meters =
          "Heat and chilled water follow the number of people: less on quiet days and in quiet "
          "hours.",
      .check = "Whether CO2 sensors drive the outdoor-air dampers.",
      .effect_class = EffectClass::outdoor_air,
      .dating = Dating::may_begin,
      .confusable =
          {{"outdoor_air_amount",
            "CO₂ of the return air over a day: constant with demand control; without it, rising "
            "with people."},
           {"hybrid_work",
            "Air flow of a nearly empty weekday: electricity falls with people in both cases, "
            "outdoor air only with demand control."},
           {"semester_calendar",
            "Heat during a winter break: without people it rises, with less outdoor air it "
            "falls."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {any_share("demand_share", "share of the outdoor air")};
      },
      // If only some rooms are served round the clock, these are laboratories, whose hoods do not
      // count people: only the share of the running handlers that serves daytime rooms is
      // throttled.
      .bind =
          [](const SiteFacts& facts, Values values, int) {
            return operating(
                [demand_share = values[0], always_share = always_share(facts.building)](
                    const DriverHour&, StepOperation& op) {
                  const double by_day = (1.0 - always_share) * op.daytime_share;
                  const double running = always_share + by_day;
                  if (running <= 0.0) return;
                  const double absence = 1.0 - std::clamp(op.people_share, 0.0, 1.0);
                  op.outdoor_air_m3_s *= 1.0 - demand_share * absence * (by_day / running);
                });
          },
  };
}

}  // namespace recald::diagnosis::effects
