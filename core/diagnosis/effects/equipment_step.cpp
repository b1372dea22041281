/// Equipment is added or removed on one day.
#include <algorithm>

#include "core/diagnosis/effects/support/meter_priors.hpp"

namespace recald::diagnosis::effects {

Effect equipment_step();

namespace {

using model::hourly::StepOperation;

double mean_plugs_W(const model::Drivers& drivers) {
  double sum_W = 0.0;
  for (const model::DriverHour& hour : drivers.hours) sum_W += hour.plugs_W;
  return drivers.hours.empty() ? 0.0 : sum_W / static_cast<double>(drivers.hours.size());
}

class EquipmentStep final : public model::hourly::Alteration {
 public:
  EquipmentStep(double power_kW, double following, double mean_plugs_W)
      : power_W_(1e3 * power_kW), following_(following), mean_plugs_W_(mean_plugs_W) {}

  void operate(const model::DriverHour& hour, StepOperation& operation) const override {
    const double use = mean_plugs_W_ > 0.0 ? hour.plugs_W / mean_plugs_W_ : 1.0;
    const double shape = 1.0 - following_ + following_ * use;
    operation.plugs_W = std::max(operation.plugs_W + power_W_ * shape, 0.0);
  }

 private:
  double power_W_;
  double following_;
  double mean_plugs_W_;
};

std::vector<EffectParameter> parameters(const SiteFacts& facts) {
  const double sd_kW = share_of_mean_kW(facts, metering::Utility::electricity, 0.10);
  return {{.name = "power",
           .unit = "kW",
           .prior = TruncatedNormalPrior{.location = 0.0, .sd = sd_kW},
           .neutral = 0.0},
          either_share("following_use")};
}

std::unique_ptr<model::hourly::Alteration> bind(const SiteFacts& facts,
                                                std::span<const double> values, int) {
  return std::make_unique<EquipmentStep>(values[0], values[1], mean_plugs_W(facts.drivers));
}

}  // namespace

Effect equipment_step() {
  return {.id = "equipment_step",
          .title = "Equipment added or removed",
          .meaning =
              "From some day on the building uses more electricity (or less), which also warms the "
              "rooms more (or less): a new machine, or a retrofit.",
          .physics =
              "plugs + dP s(t) from the date; s = 1 - b + b plugs/mean plugs, dP mean power "
              "in kW, b in -",
          .effect_class = EffectClass::electrical,
          .dating = Dating::must_begin,
          .confusable =
              {{"plug_growth", "Night electricity week by week around the date: step or slope."},
               {"phase_lost",
                "Chilled water after the date: equipment moves it, a lost phase does not."},
               {"vacancy",
                "The number of people in the building: badge or lift counts after the date."}},
          .parameters = parameters,
          .bind = bind};
}

}  // namespace recald::diagnosis::effects
