/// The number of plugged-in devices grows or shrinks every year.
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/spanned_days.hpp"

namespace recald::diagnosis::effects {

Effect plug_growth() {
  return {
      .id = "plug_growth",
      .title = "Plug loads drift over the years",
      .meaning =
          "The number of plugged-in devices grows (or falls) year by year, at all hours, and "
          "with it the heat they give off.",
      .physics =
          "plugs x (1 + g (t - t_mid)); t in years, t_mid middle of the record, g in "
          "1/year",
      .on_meters =
          "Electricity drifts steadily over the years at all hours; chilled water rises and heat "
          "falls a little with it.",
      .check = "What was plugged in over these years: compare electricity at night, year by year.",
      .effect_class = EffectClass::electrical,
      .confusable =
          {{"equipment_step",
            "Electricity at night over the year: drift grows steadily, a step stays constant."},
           {"fouling", "Electricity on winter weekends: plugs also drift then."}},
      // Bounds of the prior keep plugs positive over records of up to six years.
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "growth",
                 .unit = "1/a",
                 .prior = TruncatedNormalPrior{.location = 0.0, .sd = 0.1, .min = -0.3, .max = 0.3},
                 .neutral = 0.0}};
      },
      // Pivots at the middle of the record, because the plug profile is a mean over the record and
      // growth from its first day would also raise that mean.
      .bind =
          [](const SiteFacts& facts, Values values, int) {
            return operating([per_year = values[0], middle_day = 0.5 * spanned_days(facts.drivers)](
                                 const DriverHour& hour, StepOperation& operation) {
              const double years = (elapsed_days(hour) - middle_day) / kDaysPerYear;
              operation.plugs_W *= 1.0 + per_year * years;
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
