/// Part of the rooms is served day and night.
#include "core/diagnosis/effect.hpp"
#include "core/diagnosis/effects/support/plant_hours.hpp"

namespace recald::diagnosis::effects {
namespace {

/// The rooms' own electricity is already in the meter's profile; only air and set-points change.
class RoundTheClockZone final : public model::hourly::Alteration {
 public:
  explicit RoundTheClockZone(double floor_share) : floor_share_(floor_share) {}

  void operate(const model::DriverHour&, model::hourly::StepOperation& op) const override {
    run_at_least(floor_share_, op);
  }

 private:
  double floor_share_;
};

std::vector<EffectParameter> parameters_of_round_the_clock_zone(const SiteFacts&) {
  return {{.name = "floor_share",
           .unit = "share of the daytime rooms",
           .prior = UniformPrior{0.0, 0.6},
           .neutral = 0.0}};
}

std::unique_ptr<model::hourly::Alteration> bind_round_the_clock_zone(const SiteFacts&,
                                                                     std::span<const double> values,
                                                                     int) {
  return std::make_unique<RoundTheClockZone>(values[0]);
}

}  // namespace

Effect round_the_clock_zone();

Effect round_the_clock_zone() {
  return {
      .id = "round_the_clock_zone",
      .title = "Laboratory or other round-the-clock zone",
      .meaning =
          "Part of the building, such as laboratories or a control room, has its fans, "
          "heating and cooling on day and night.",
      .physics =
          "on = max(on, φ) at all hours; φ [–] 0…0.6: share of the rooms drawn as daytime "
          "rooms that keeps its occupied set-points and air flow",
      .on_meters =
          "Electricity, heat and chilled water are higher at night and on weekends, all together.",
      .check =
          "Which rooms have air day and night: laboratories, control rooms, a zone with an "
          "override.",
      .effect_class = EffectClass::schedule,
      .dating = Dating::may_begin,
      .confusable =
          {{"server_room",
            "Heat on cold nights: a server room saves heat, a ventilated zone costs it."},
           {"damper_stuck_open", "Fan power at night: an open damper lets air in without any fan."},
           {"night_setback_missing",
            "Electricity at night: set-points alone hardly change it, running fans do."},
           {"constant_flow_pumps",
            "Whether the extra electricity at night also shows in chilled water and heat."}},
      .parameters = parameters_of_round_the_clock_zone,
      .bind = bind_round_the_clock_zone,
  };
}

}  // namespace recald::diagnosis::effects
