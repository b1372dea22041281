/// Set-points are not relaxed when the rooms are unoccupied.
#include "core/diagnosis/effect.hpp"

namespace recald::diagnosis::effects {
namespace {

class NightSetBackMissing final : public model::hourly::Alteration {
 public:
  explicit NightSetBackMissing(double missing_share) : missing_share_(missing_share) {}

  void operate(const model::DriverHour&, model::hourly::StepOperation& op) const override {
    op.heating_unoccupied_C += missing_share_ * (op.heating_occupied_C - op.heating_unoccupied_C);
    op.cooling_unoccupied_C += missing_share_ * (op.cooling_occupied_C - op.cooling_unoccupied_C);
  }

 private:
  double missing_share_;
};

std::vector<EffectParameter> parameters_of_night_setback_missing(const SiteFacts&) {
  return {{.name = "missing_share",
           .unit = "share of the set-back",
           .prior = UniformPrior{0.0, 1.0},
           .neutral = 0.0}};
}

std::unique_ptr<model::hourly::Alteration> bind_night_setback_missing(
    const SiteFacts&, std::span<const double> values, int) {
  return std::make_unique<NightSetBackMissing>(values[0]);
}

}  // namespace

Effect night_setback_missing();

Effect night_setback_missing() {
  return {
      .id = "night_setback_missing",
      .title = "Night set-back missing",
      .meaning =
          "Rooms are heated and cooled at night and on weekends almost as during the day: the "
          "thermostats are not set back when everybody has left.",
      .physics =
          "θ_unocc [°C] = θ_unocc,drawn + f·(θ_occ − θ_unocc,drawn), for heating and "
          "cooling; f [–] 0…1, 0: set-back as drawn, 1: none",
      .on_meters =
          "Heat and chilled water stay high at night and on weekends, and the peak of the morning "
          "start is small.",
      .check =
          "The unoccupied set-points in the controls, and a room temperature logger over one "
          "night.",
      .effect_class = EffectClass::schedule,
      .dating = Dating::may_begin,
      .needs = {.night_set_back = true},
      .confusable = {{"damper_stuck_open",
                      "Compare cold calm nights: the load of an open damper also follows the "
                      "humidity, and the morning warm-up spike remains. A room temperature logger "
                      "over one night settles it."},
                     {"thermal_mass",
                      "Room temperature over a weekend: in a heavy building it falls slowly, but "
                      "it falls; without set-back it stays constant."},
                     {"stack_infiltration",
                      "Look for the warm-up spike on Monday morning: with leaks it is there, with "
                      "a missing set-back it is not."},
                     {"after_hours",
                      "Fan power at 02:00: later hours end at some time in the evening, a missing "
                      "set-back lasts until morning and all weekend."}},
      .parameters = parameters_of_night_setback_missing,
      .bind = bind_night_setback_missing,
  };
}

}  // namespace recald::diagnosis::effects
