/// Heating and cooling work against each other.
#include <algorithm>

#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {
namespace {

/// Mean of chilled water; with an own chiller, that of heat; else 10 W/m².
double reheat_reference_kW(const SiteFacts& facts) {
  const double cooling_kW = facts.mean_of_kW(metering::Utility::chilled_water);
  if (cooling_kW > 0.0) return cooling_kW;
  const double heating_kW = facts.mean_of_kW(metering::Utility::heating);
  return heating_kW > 0.0 ? heating_kW : 0.01 * facts.building.floor_area_m2;
}

}  // namespace

Effect simultaneous_heating_cooling() {
  return {
      .id = "simultaneous_heating_cooling",
      .title = "Simultaneous heating and cooling",
      .meaning =
          "While the fans run, heat goes into air that wants none, for instance because a valve "
          "leaks, and the cooling takes it out again. Nobody notices, because the rooms stay "
          "comfortable.",
      .physics =
          "Q_cool [kW] += w, Q_heat [kW] += w, w = max(q·on − Q_wanted, 0); Q_wanted: by reheat "
          "and rooms; on: share of the air handlers that runs [–]; q [kW] ≥ 0",
      .on_meters = "Heat and chilled water rise together while the fans run, in hot weather too.",
      .check =
          "The heating valves and reheat coils: close them for an hour and see whether both meters "
          "fall.",
      .effect_class = EffectClass::air_system,
      .dating = Dating::may_begin,
      .needs = {.air_system = true},
      .confusable =
          {{"supply_reset_missing",
            "Plot heat against outdoor temperature: a leaking valve heats in the hottest weather "
            "too. The effect of a missing reset stops at a certain temperature."},
           {"economiser_failed",
            "Heat in mild weather: only simultaneous heating and cooling raises it together with "
            "chilled water."},
           {"steam_trap_leak",
            "Nights with the fans off, and chilled water: pipe losses do not show in chilled "
            "water."},
           {"scale_fault",
            "Whether an error of a single meter explains it: close the heating valves for an hour "
            "and check that both meters fall."}},
      .parameters = [](const SiteFacts& facts) -> Parameters {
        // What leaks. Only what leaks beyond the heat that is wanted is waste.
        return {{.name = "wasted_heat",
                 .unit = "kW",
                 .prior = half_normal(0.1 * reheat_reference_kW(facts)),
                 .neutral = 0.0}};
      },
      .bind =
          [](const SiteFacts&, Values values, int) {
            return supplying([leaking_kW = values[0]](const model::Building&, const DriverHour&,
                                                      const StepOperation&, StepLoads& loads) {
              // What leaks is no waste while as much heat is wanted.
              const double leaking_W = 1000.0 * leaking_kW * loads.running_share;
              const double wasted_W =
                  std::max(leaking_W - loads.reheat_W - loads.zone_heating_W, 0.0);
              loads.sensible_cooling_W += wasted_W;
              loads.reheat_W += wasted_W;
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
