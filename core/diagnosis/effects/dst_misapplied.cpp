/// A logger that changes its clock when the building does not, or the other way round.
#include <cstddef>

#include "core/diagnosis/effect.hpp"
#include "core/diagnosis/effects/support/shifted_record.hpp"

namespace recald::diagnosis::effects {

Effect dst_misapplied();

namespace {

/// All meters of a logger share its clock, so `record` does not ask which one it has.
class DstMisapplied final : public model::hourly::Alteration {
 public:
  explicit DstMisapplied(double offset_hours) : offset_hours_(offset_hours) {}

  void record(std::span<const model::DriverHour> hours, int /*meter*/,
              std::span<double> power_kW) const override {
    if (hours.empty()) return;
    const std::size_t steps_per_hour = power_kW.size() / hours.size();
    const std::vector<double> shifted = shifted_record(hours, power_kW, offset_hours_);
    for (std::size_t i = 0; i < power_kW.size(); ++i) {
      if (hours[i / steps_per_hour].daylight_saving) power_kW[i] = shifted[i];
    }
  }

 private:
  double offset_hours_;
};

std::vector<EffectParameter> parameters(const SiteFacts&) {
  return {{.name = "summer_offset",
           .unit = "h",
           .prior = UniformPrior{.min = -1.0, .max = 1.0},
           .neutral = 0.0,
           .scan = {-1.0, 1.0}}};
}

std::unique_ptr<model::hourly::Alteration> bind(const SiteFacts&, std::span<const double> values,
                                                int) {
  return std::make_unique<DstMisapplied>(values[0]);
}

}  // namespace

Effect dst_misapplied() {
  return {.id = "dst_misapplied",
          .title = "Daylight saving handled wrongly",
          .meaning =
              "From March to November all readings stand one hour off: the logger's clock "
              "and the building's do not agree about daylight saving.",
          .physics =
              "y(t + D) while daylight saving is on, all meters; y recorded power in kW, D "
              "in h",
          .effect_class = EffectClass::meter,
          .confusable = {{"after_hours",
                          "Both edges of the day in the week of the change: a clock moves both."},
                         {"early_start", "The evening edge: an early start leaves it alone."},
                         {"clock_offset", "Winter weeks, and the other meters of the logger."}},
          .parameters = parameters,
          .bind = bind};
}

}  // namespace recald::diagnosis::effects
