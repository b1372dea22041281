/// The plant starts earlier than in its timetable, and earlier still in the cold.
#include <algorithm>

#include "core/diagnosis/effect.hpp"
#include "core/diagnosis/effects/support/plant_hours.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {
namespace {

class EarlyStart final : public model::hourly::Alteration {
 public:
  EarlyStart(double fixed_h, double cold_h_K) : fixed_h_(fixed_h), cold_h_K_(cold_h_K) {}

  void operate(const model::DriverHour& hour, model::hourly::StepOperation& op) const override {
    const double cold_K = std::max(op.heating_occupied_C - hour.dry_bulb_C, 0.0);
    run_at_least(covered_share(fixed_h_ + cold_h_K_ * cold_K, hour.hours_to_start), op);
  }

 private:
  double fixed_h_;
  double cold_h_K_;
};

std::vector<EffectParameter> parameters_of_early_start(const SiteFacts&) {
  return {{.name = "lead",
           .unit = "h",
           .prior = half_normal(2.0),
           .neutral = 0.0,
           .scan = {0.0, 1.0, 3.0}},
          {.name = "lead_per_cold",
           .unit = "h/K",
           .prior = half_normal(0.1),
           .neutral = 0.0,
           .scan = {0.0, 0.03, 0.1}}};
}

std::unique_ptr<model::hourly::Alteration> bind_early_start(const SiteFacts&,
                                                            std::span<const double> values, int) {
  return std::make_unique<EarlyStart>(values[0], values[1]);
}

}  // namespace

Effect early_start();

Effect early_start() {
  return {
      .id = "early_start",
      .title = "Early or optimum start",
      .meaning =
          "Fans, heating and cooling start well before the time in the timetable, and even earlier "
          "on cold mornings, so that rooms are comfortable when people arrive.",
      .physics =
          "t_on [h] = t_on,drawn − (Δh_0 + b·max(θ_heat,occ − θ_e, 0)); Δh_0 [h] ≥ 0, "
          "b [h/K] ≥ 0, θ_e outdoor air [°C] of the hour",
      .on_meters =
          "Electricity and heat rise before the timetable says, earlier on colder mornings; the "
          "evening stays the same.",
      .check = "The start time and the optimum-start setting in the building controls.",
      .effect_class = EffectClass::schedule,
      .dating = Dating::may_begin,
      .confusable = {{"thermal_mass",
                      "Fan power before the timetable's start: thermal mass changes only heat, an "
                      "early start also shows in electricity."},
                     {"dst_misapplied",
                      "Whether the evening stop also moved by an hour, and only in summer."},
                     {"clock_offset", "The evening stop: an early start does not change it."},
                     {"night_setback_missing",
                      "The start spike grows with the cold; there is none on weekends without a "
                      "start afterwards."}},
      .parameters = parameters_of_early_start,
      .bind = bind_early_start,
  };
}

}  // namespace recald::diagnosis::effects
