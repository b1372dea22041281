/// The plant runs on Saturdays or Sundays.
#include <algorithm>

#include "core/diagnosis/effect.hpp"
#include "core/diagnosis/effects/support/plant_hours.hpp"

namespace recald::diagnosis::effects {
namespace {

/// People, lights and plugs do not change: the last two come from the meter's own profile of
/// Saturdays and Sundays.
class WeekendOperation final : public model::hourly::Alteration {
 public:
  WeekendOperation(const model::SetPoints& set_points, double saturday_share, double sunday_share)
      : from_hour_(set_points.occupied_from_hour),
        to_hour_(set_points.occupied_to_hour),
        saturday_share_(saturday_share),
        sunday_share_(sunday_share) {}

  void operate(const model::DriverHour& hour, model::hourly::StepOperation& op) const override {
    if (hour.local_hour < from_hour_ || hour.local_hour >= to_hour_) return;
    if (hour.weekday == 6) run_at_least(saturday_share_, op);
    if (hour.weekday == 0) run_at_least(sunday_share_, op);
  }

 private:
  int from_hour_;
  int to_hour_;
  double saturday_share_;
  double sunday_share_;
};

std::vector<EffectParameter> parameters_of_weekend_operation(const SiteFacts&) {
  return {{.name = "saturday_share",
           .unit = "share of a weekday's plant",
           .prior = UniformPrior{0.0, 1.0},
           .neutral = 0.0},
          {.name = "sunday_share",
           .unit = "share of a weekday's plant",
           .prior = UniformPrior{0.0, 1.0},
           .neutral = 0.0}};
}

std::unique_ptr<model::hourly::Alteration> bind_weekend_operation(const SiteFacts& facts,
                                                                  std::span<const double> values,
                                                                  int) {
  return std::make_unique<WeekendOperation>(facts.building.set_points, values[0], values[1]);
}

}  // namespace

Effect weekend_operation();

Effect weekend_operation() {
  return {
      .id = "weekend_operation",
      .title = "Weekend operation",
      .meaning =
          "Fans, heating and cooling run on Saturdays or Sundays at weekday hours, although the "
          "building is closed according to the timetable.",
      .physics =
          "on(Sat, Sun) = max(on, φ_day·on_weekday); φ_Sat, φ_Sun [–] 0…1: share of the "
          "daytime rooms that is served at weekday hours",
      .on_meters =
          "All meters show weekday hours on Saturdays or Sundays; weekday nights stay the same.",
      .check = "The weekend timetable and the overrides in the building controls.",
      .effect_class = EffectClass::schedule,
      .dating = Dating::may_begin,
      .confusable =
          {{"constant_speed_fans",
            "Fan power on a Saturday: zero outside the timetable if only the speed is wrong."},
           {"missing_holidays",
            "Compare ordinary weekends with the weeks around public holidays. The weekend "
            "timetable in the building controls settles it."},
           {"round_the_clock_zone",
            "Power at 03:00 on a weekday: weekend operation does not change weekday nights."},
           {"exterior_lighting",
            "The evening change of electricity compared with sunset, in 15-minute values: lamps "
            "follow the sun, the plant follows the clock."},
           {"solar_gain_change",
            "Compare sunny with cloudy weekends at the same outdoor temperature."}},
      .parameters = parameters_of_weekend_operation,
      .bind = bind_weekend_operation,
  };
}

}  // namespace recald::diagnosis::effects
