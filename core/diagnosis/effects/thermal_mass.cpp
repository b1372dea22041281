/// The building stores more or less heat than typical for its construction.
#include "core/diagnosis/effect.hpp"

namespace recald::diagnosis::effects {

Effect thermal_mass();

namespace {

class ThermalMass final : public model::hourly::Alteration {
 public:
  explicit ThermalMass(double factor) : factor_(factor) {}

  void rebuild(model::Building& building) const override {
    building.heat_capacity_J_m2K *= factor_;
  }

 private:
  double factor_;
};

std::vector<EffectParameter> parameters_of_thermal_mass(const SiteFacts&) {
  return {{.name = "mass_factor",
           .unit = "-",
           .prior = LogNormalPrior{.median = 1.0, .log_sd = 0.5, .min = 0.2, .max = 5.0},
           .neutral = 1.0}};
}

std::unique_ptr<model::hourly::Alteration> bind_thermal_mass(const SiteFacts&,
                                                             std::span<const double> values, int) {
  return std::make_unique<ThermalMass>(values[0]);
}

}  // namespace

Effect thermal_mass() {
  return {
      .id = "thermal_mass",
      .title = "Building heavier or lighter than drawn",
      .meaning =
          "The building warms and cools more slowly (or faster) than its construction "
          "suggests. Nothing is broken, but start times should take it into account.",
      .physics = "heat capacity C_m x m; C_m in J/(m2 K) of floor area, m in -",
      .on_meters =
          "Heat and cooling follow the outdoor temperature more slowly or faster; over a day they "
          "stay nearly the same.",
      .check =
          "The construction against the drawings, and how room temperature falls over a weekend.",
      .effect_class = EffectClass::envelope,
      .confusable = {{"early_start",
                      "Fan status at dawn: an early start shows there, slow walls do not."},
                     {"night_setback_missing",
                      "Room temperature after a clear night: with a heavy mass it falls "
                      "slowly, with a missing set-back it stays constant."}},
      .parameters = parameters_of_thermal_mass,
      .bind = bind_thermal_mass};
}

}  // namespace recald::diagnosis::effects
