/// Steam that is paid for but heats no room.
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {

Effect steam_trap_leak() {
  return {
      .id = "steam_trap_leak",
      .title = "Steam or heat leaks in the pipes",
      .meaning =
          "Heat is used day and night, even in summer, without heating any room: steam traps "
          "stuck open, bare pipes or a leaking valve.",
      .physics = "heat meter + L at all hours; L in kW as metered",
      .on_meters =
          "Heat is higher by the same amount at all hours, in summer too; no other meter changes.",
      .check = "The steam traps, the bare pipes and the valves, on a summer night without use.",
      .effect_class = EffectClass::plant,
      .dating = Dating::may_begin,
      .confusable =
          {{"seasonal_hot_water",
            "Close the hot-water loop's valve for a summer night and read the heat meter."},
           {"simultaneous_heating_cooling",
            "Chilled water on the same nights: reheat raises both, a leak only the heat."},
           {"scale_fault",
            "Compare the ratio of metered to expected heat in January and in July."}},
      .parameters = [](const SiteFacts& facts) -> Parameters {
        const double sd_kW = share_of_mean_kW(facts, metering::Utility::heating, 0.15);
        return {{.name = "heat_loss", .unit = "kW", .prior = half_normal(sd_kW), .neutral = 0.0}};
      },
      .bind =
          [](const SiteFacts&, Values values, int) {
            return supplying([loss_kW = values[0]](const model::Building&, const DriverHour&,
                                                   const StepOperation&, StepLoads& loads) {
              loads.base_heat_W += 1e3 * loss_kW;
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
