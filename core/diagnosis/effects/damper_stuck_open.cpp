/// Outdoor air enters through stopped handlers.
#include "core/diagnosis/effect.hpp"

namespace recald::diagnosis::effects {
namespace {

/// Only stopped handlers change: while they run, the fans' suction sets the outdoor air. The model
/// itself leaves out rooms that are being served.
class DamperStuckOpen final : public model::hourly::Alteration {
 public:
  explicit DamperStuckOpen(double open_share) : open_share_(open_share) {}

  void operate(const model::DriverHour&, model::hourly::StepOperation& op) const override {
    op.idle_outdoor_air_m3_s += open_share_ * op.outdoor_air_m3_s;
  }

 private:
  double open_share_;
};

std::vector<EffectParameter> parameters(const SiteFacts&) {
  return {{.name = "open_share",
           .unit = "share of the daytime outdoor air",
           .prior = UniformPrior{0.0, 0.6},
           .neutral = 0.0}};
}

std::unique_ptr<model::hourly::Alteration> bind(const SiteFacts&, std::span<const double> values,
                                                int) {
  return std::make_unique<DamperStuckOpen>(values[0]);
}

}  // namespace

Effect damper_stuck_open();

Effect damper_stuck_open() {
  return {
      .id = "damper_stuck_open",
      .title = "Outdoor-air damper stuck open",
      .meaning =
          "At night and on weekends, cold or humid outdoor air enters through an air handler whose "
          "damper does not close. Heating and the morning cool-down have to make up for it.",
      .physics =
          "V_oa [m³/s] = V_oa,day·max(schedule, φ) with fans off; it meets the rooms directly; φ "
          "[–] 0…0.6",
      .effect_class = EffectClass::outdoor_air,
      .dating = Dating::may_begin,
      .needs = {.air_system = true},
      .confusable = {{"stack_infiltration",
                      "Stop the fans for one cold night with the damper closed by hand: leaks "
                      "remain, the damper's share disappears. Leaks also grow more than linearly "
                      "with the temperature difference."},
                     {"wind_infiltration",
                      "Compare calm with windy nights at the same temperature: the flow through a "
                      "damper hardly depends on the wind."},
                     {"night_setback_missing",
                      "Humid summer nights: outdoor air brings moisture that raises chilled water "
                      "in the morning, set-points do not."},
                     {"ground_coupling",
                      "The delay behind outdoor temperature: heat to the ground lags by weeks, "
                      "outdoor air not at all."},
                     {"round_the_clock_zone", "Fan power at night: an open damper needs none."}},
      .parameters = parameters,
      .bind = bind,
  };
}

}  // namespace recald::diagnosis::effects
