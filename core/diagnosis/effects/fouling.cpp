/// Cooling costs more from month to month, until the condenser is cleaned.
#include <algorithm>

#include "core/absent.hpp"
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"
#include "core/diagnosis/effects/support/spanned_days.hpp"

namespace recald::diagnosis::effects {

Effect fouling() {
  return {
      .id = "fouling",
      .title = "Cooling plant fouls slowly",
      .meaning =
          "The same cooling takes a little more electricity each month, as tubes, coils or "
          "filters clog. Cleaning restores the efficiency at once.",
      .physics =
          "cost of cooling x (1 + r years); years since fouling began or since the last "
          "cleaning, r in 1/year",
      .on_meters =
          "Electricity, or chilled water where it is bought, rises year by year for the same "
          "cooling; a cleaning ends it.",
      .check =
          "The chiller's approach temperatures, the tower, the coils and the filters; the date "
          "of the last cleaning.",
      .effect_class = EffectClass::plant,
      .confusable = {{"scale_fault",
                      "Compare two summers: a wrong scale is constant, fouling grows."},
                     {"plug_growth",
                      "Electricity on winter weekends: plugs grow there, fouling does "
                      "not."},
                     {"chiller_part_load",
                      "Chiller power at one load and tower temperature, this year and last."}},
      .parameters = [](const SiteFacts& facts) -> Parameters {
        const double days = spanned_days(facts.drivers);
        const double none = kAbsent;
        return {{.name = "growth",
                 .unit = "1/a",
                 .prior = half_normal_below(0.08, 1.0),
                 .neutral = 0.0},
                {.name = "from_day",
                 .unit = "d",
                 .prior = UniformPrior{.min = 0.0, .max = days},
                 .neutral = none,
                 .scan = {0.0, 0.25 * days, 0.5 * days, 0.75 * days}},
                // The last day stands for "not cleaned in this record".
                {.name = "cleaned_day",
                 .unit = "d",
                 .prior = UniformPrior{.min = 0.0, .max = days},
                 .neutral = none,
                 .scan = {0.3 * days, 0.4 * days, 0.5 * days, 0.6 * days, 0.8 * days, days}}};
      },
      // Its dates are part of its physics (growth counts from one and restarts at the other), so
      // they are parameters here. The wrapper could only switch the effect on and off.
      .bind =
          [](const SiteFacts&, Values values, int) {
            return supplying([per_year = values[0], from_day = values[1], cleaned_day = values[2]](
                                 const model::Building&, const DriverHour& hour,
                                 const StepOperation&, StepLoads& loads) {
              const double day = elapsed_days(hour);
              const double clean_day =
                  day < cleaned_day ? from_day : std::max(from_day, cleaned_day);
              const double years = std::max(day - clean_day, 0.0) / kDaysPerYear;
              loads.cooling_cost_factor *= 1.0 + per_year * years;
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
