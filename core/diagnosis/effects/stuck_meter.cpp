/// A meter that repeats itself.

#include "core/absent.hpp"
#include "core/diagnosis/effect.hpp"

namespace recald::diagnosis::effects {

Effect stuck_meter();

namespace {

/// Applies within its window. The share between a live and a dead meter only helps the search: real
/// meters are at 1.
class StuckMeter final : public model::hourly::Alteration {
 public:
  StuckMeter(double stuck_share, double level_share, int meter)
      : stuck_share_(stuck_share), level_share_(level_share), meter_(meter) {}

  void record(std::span<const model::DriverHour>, int meter,
              std::span<double> power_kW) const override {
    if (meter != meter_ || power_kW.empty()) return;
    const double level_kW = level_share_ * power_kW.front();
    for (double& value_kW : power_kW) value_kW += stuck_share_ * (level_kW - value_kW);
  }

 private:
  double stuck_share_;
  double level_share_;
  int meter_;
};

std::vector<EffectParameter> parameters_of_stuck_meter(const SiteFacts&) {
  const UniformPrior any_share{.min = 0.0, .max = 1.0};
  return {{.name = "stuck_share", .unit = "-", .prior = any_share, .neutral = 0.0},
          {.name = "level_share",
           .unit = "-",
           .prior = any_share,
           .neutral = kAbsent,
           .scan = {0.0, 1.0}}};
}

std::unique_ptr<model::hourly::Alteration> bind_stuck_meter(const SiteFacts&,
                                                            std::span<const double> values,
                                                            int meter) {
  return std::make_unique<StuckMeter>(values[0], values[1], meter);
}

}  // namespace

Effect stuck_meter() {
  return {.id = "stuck_meter",
          .title = "Meter is frozen",
          .meaning =
              "For some time the meter repeats its last value, or zero, although the building "
              "still uses energy. Check its pulse output and its line.",
          .physics =
              "y + s (l y(t1) - y) from t1 to t2; y recorded power in kW, s = 1 a dead "
              "meter, l = 0 zero, l = 1 the last value",
          .on_meters =
              "One meter repeats its last value, or zero, for a while; the other meters go on as "
              "usual.",
          .check = "The meter's pulse output, its line and its logger in that time.",
          .effect_class = EffectClass::meter,
          .dating = Dating::window,
          .of_one_meter = true,
          .confusable = {{"vacancy", "The other meters: in an empty building they also fall."},
                         {"missing_holidays", "The other meters on that date."}},
          .parameters = parameters_of_stuck_meter,
          .bind = bind_stuck_meter};
}

}  // namespace recald::diagnosis::effects
