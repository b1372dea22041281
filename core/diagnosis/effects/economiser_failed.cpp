/// Free cooling does not work.
#include "core/diagnosis/effect.hpp"

namespace recald::diagnosis::effects {
namespace {

class EconomiserFailed final : public model::hourly::Alteration {
 public:
  explicit EconomiserFailed(double failed_share) : failed_share_(failed_share) {}

  void operate(const model::DriverHour&, model::hourly::StepOperation& op) const override {
    op.economiser_share *= 1.0 - failed_share_;
  }

 private:
  double failed_share_;
};

std::vector<EffectParameter> parameters_of_economiser_failed(const SiteFacts&) {
  return {{.name = "failed_share",
           .unit = "share of the free-cooling flow",
           .prior = UniformPrior{0.0, 1.0},
           .neutral = 0.0}};
}

std::unique_ptr<model::hourly::Alteration> bind_economiser_failed(const SiteFacts&,
                                                                  std::span<const double> values,
                                                                  int) {
  return std::make_unique<EconomiserFailed>(values[0]);
}

}  // namespace

Effect economiser_failed();

Effect economiser_failed() {
  return {
      .id = "economiser_failed",
      .title = "Economiser failed or missing",
      .meaning =
          "On mild days chilled water cools the building although cool outdoor air could do it for "
          "free: the dampers do not open beyond their minimum position.",
      .physics = "free-cooling flow [m³/s] ×(1−f); f [–] 0…1, 1: no free cooling",
      .on_meters =
          "Chilled water is used on cool days, when it should be near zero; heat stays the same.",
      .check =
          "The dampers on a dry, cool morning: whether they open beyond their minimum position.",
      .effect_class = EffectClass::outdoor_air,
      .dating = Dating::may_begin,
      .needs = {.air_system = true, .economiser = true},
      .confusable = {{"supply_reset_missing",
                      "Heat on the same days: a failed economiser only costs chilled water, supply "
                      "air that is too cold also costs reheat."},
                     {"economiser_changeover",
                      "The outdoor temperature at which chilled water starts: a wrong change-over "
                      "moves it by a few kelvin, a failure raises all hours below it."},
                     {"solar_gain_change",
                      "Compare cloudy with sunny mild days; or watch the damper position on a dry "
                      "12 °C morning."},
                     {"simultaneous_heating_cooling",
                      "Chilled water at 12 °C with the economiser opened by hand: it falls to near "
                      "zero if the economiser was the cause."}},
      .parameters = parameters_of_economiser_failed,
      .bind = bind_economiser_failed,
  };
}

}  // namespace recald::diagnosis::effects
