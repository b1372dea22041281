/// Steam that is paid for but heats no room.
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {

Effect steam_trap_leak();

namespace {

using model::hourly::StepLoads;
using model::hourly::StepOperation;

class SteamTrapLeak final : public model::hourly::Alteration {
 public:
  explicit SteamTrapLeak(double loss_kW) : loss_kW_(loss_kW) {}

  void supply(const model::Building&, const model::DriverHour&, const StepOperation&,
              StepLoads& loads) const override {
    loads.base_heat_W += 1e3 * loss_kW_;
  }

 private:
  double loss_kW_;
};

std::vector<EffectParameter> parameters_of_steam_trap_leak(const SiteFacts& facts) {
  const double sd_kW = share_of_mean_kW(facts, metering::Utility::heating, 0.15);
  return {{.name = "heat_loss", .unit = "kW", .prior = half_normal(sd_kW), .neutral = 0.0}};
}

std::unique_ptr<model::hourly::Alteration> bind_steam_trap_leak(const SiteFacts&,
                                                                std::span<const double> values,
                                                                int) {
  return std::make_unique<SteamTrapLeak>(values[0]);
}

}  // namespace

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
      .parameters = parameters_of_steam_trap_leak,
      .bind = bind_steam_trap_leak};
}

}  // namespace recald::diagnosis::effects
