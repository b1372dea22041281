/// Fans do not slow down with the flow.
#include "core/diagnosis/effect.hpp"

namespace recald::diagnosis::effects {
namespace {

class ConstantSpeedFans final : public model::hourly::Alteration {
 public:
  explicit ConstantSpeedFans(double constant_share) : constant_share_(constant_share) {}

  void operate(const model::DriverHour&, model::hourly::StepOperation& op) const override {
    op.constant_fan_share += constant_share_ * (1.0 - op.constant_fan_share);
  }

 private:
  double constant_share_;
};

std::vector<EffectParameter> parameters_of_constant_speed_fans(const SiteFacts&) {
  return {{.name = "constant_share",
           .unit = "share of the fans",
           .prior = UniformPrior{0.0, 1.0},
           .neutral = 0.0}};
}

std::unique_ptr<model::hourly::Alteration> bind_constant_speed_fans(const SiteFacts&,
                                                                    std::span<const double> values,
                                                                    int) {
  return std::make_unique<ConstantSpeedFans>(values[0]);
}

}  // namespace

Effect constant_speed_fans();

Effect constant_speed_fans() {
  return {
      .id = "constant_speed_fans",
      .title = "Fans at constant speed",
      .meaning =
          "The fans always run at full power, although the boxes need less air: speed drives are "
          "missing, bypassed or locked.",
      .physics = "fan power share g(r) ← (1−f)·g(r) + f, r flow over design flow [–]; f [–] 0…1",
      .on_meters =
          "Electricity is flat while the plant runs, and higher on mild days; heat and chilled "
          "water hardly change.",
      .check = "The fans' speed drives: bypassed, locked by hand, or missing.",
      .effect_class = EffectClass::air_system,
      .dating = Dating::may_begin,
      .needs = {.reheat_boxes = true},
      .confusable = {{"demand_limit",
                      "Hot afternoons: constant fans are flat on all days, a demand limit only "
                      "cuts the peaks."},
                     {"weekend_operation", "Fan power on Saturdays and Sundays."},
                     {"constant_flow_pumps", "Electricity at night with the fans off."},
                     {"equipment_step",
                      "Electricity plotted against chilled water at a fixed hour: with constant "
                      "fans there is no slope. A clamp meter on one fan settles it."}},
      .parameters = parameters_of_constant_speed_fans,
      .bind = bind_constant_speed_fans,
  };
}

}  // namespace recald::diagnosis::effects
