/// The plant stops later than in its timetable.
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/plant_hours.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {

Effect after_hours() {
  return {
      .id = "after_hours",
      .title = "After-hours operation",
      .meaning =
          "On working days fans, heating and cooling keep running after the end of the timetable, "
          "for instance because nobody has cancelled an override.",
      .physics = "t_off [h] = t_off,drawn + Δh on days with plant operation; Δh [h] ≥ 0",
      .on_meters =
          "Electricity, heating and cooling fall some hours later than the timetable says, on "
          "working days only.",
      .check =
          "The overrides and the stop time in the building controls, and fan status after hours.",
      .effect_class = EffectClass::schedule,
      .dating = Dating::may_begin,
      .confusable = {{"dst_misapplied",
                      "The shutdown time in 15-minute values: a clock error comes and goes with "
                      "daylight saving and also moves the morning."},
                     {"clock_offset",
                      "The start time: a wrong clock moves start and stop alike, and also the "
                      "loads that follow the sun."},
                     {"exterior_lighting",
                      "Whether the shutdown time follows sunset over the year, and whether chilled "
                      "water follows it."},
                     {"night_setback_missing", "Power at 03:00, long after any late stop."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "late_stop",
                 .unit = "h",
                 .prior = half_normal(3.0),
                 .neutral = 0.0,
                 .scan = {1.0, 2.0, 4.0}}};
      },
      // Counts from the last stop, so a late stop may extend past midnight, on Fridays into
      // Saturday.
      .bind =
          [](const SiteFacts&, Values values, int) {
            return operating([late_h = values[0]](const DriverHour& hour, StepOperation& op) {
              run_at_least(covered_share(late_h, hour.hours_since_stop), op);
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
