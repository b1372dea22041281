/// The plant runs on Saturdays or Sundays.
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/plant_hours.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {

Effect weekend_operation() {
  return {
      .id = "weekend_operation",
      .title = "Weekend operation",
      .meaning =
          "Fans, heating and cooling run on Saturdays or Sundays at weekday hours, although the "
          "building is closed according to the timetable.",
      .physics =
          "on(Sat, Sun) = max(on, φ_day·on_weekday); φ_Sat, φ_Sun [–] 0…1: share of the "
          "daytime rooms that is served at weekday hours",
      .on_meters =
          "All meters show weekday hours on Saturdays or Sundays; weekday nights stay the same.",
      .check = "The weekend timetable and the overrides in the building controls.",
      .effect_class = EffectClass::schedule,
      .dating = Dating::may_begin,
      .confusable =
          {{"constant_speed_fans",
            "Fan power on a Saturday: zero outside the timetable if only the speed is wrong."},
           {"missing_holidays",
            "Compare ordinary weekends with the weeks around public holidays. The weekend "
            "timetable in the building controls settles it."},
           {"round_the_clock_zone",
            "Power at 03:00 on a weekday: weekend operation does not change weekday nights."},
           {"exterior_lighting",
            "The evening change of electricity compared with sunset, in 15-minute values: lamps "
            "follow the sun, the plant follows the clock."},
           {"solar_gain_change",
            "Compare sunny with cloudy weekends at the same outdoor temperature."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {any_share("saturday_share", "share of a weekday's plant"),
                any_share("sunday_share", "share of a weekday's plant")};
      },
      // People, lights and plugs do not change: the last two come from the meter's own profile of
      // Saturdays and Sundays.
      .bind =
          [](const SiteFacts& facts, Values values, int) {
            return operating([from_hour = facts.building.set_points.occupied_from_hour,
                              to_hour = facts.building.set_points.occupied_to_hour,
                              saturday_share = values[0],
                              sunday_share = values[1]](const DriverHour& hour, StepOperation& op) {
              if (hour.local_hour < from_hour || hour.local_hour >= to_hour) return;
              if (hour.weekday == 6) run_at_least(saturday_share, op);
              if (hour.weekday == 0) run_at_least(sunday_share, op);
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
