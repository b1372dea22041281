#include <algorithm>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

/// A cautiously set start programme: the colder the evening before, the earlier the start, and
/// earlier still after a day on which the building has cooled down.
class EarlyStart final : public EffectWithSettings {
 public:
  EarlyStart(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), evening_C_(kEvening_s) {}

  void plan(metering::Day day, Timetable& timetable) override {
    const double mood = settings_.rng.uniform(0.85, 1.15);
    RunningHours& air = timetable.air;
    const bool runs = air.from_h < air.to_h;
    if (settings_.covers(day) && runs) {
      // 0.5 on mild days, 1 at 5 degC, 1.5 at -5 degC and below.
      const double cold = 0.5 + ramp(evening_C_.value(), 15.0, -5.0);
      const double rested = ran_yesterday_ ? 1.0 : 1.3;
      const double earlier_h = settings_.strength * cold * rested * mood;
      air.from_h = std::min(air.from_h, std::max(0.0, air.from_h - earlier_h));
    }
    ran_yesterday_ = runs;
  }

  void operate(const Moment& now, Operation& /*operation*/) override {
    evening_C_.follow(now.outdoors.air.temperature_C, now.step_s);
  }

 private:
  static constexpr double kEvening_s = 3.0 * 3600.0;

  SlowValue evening_C_;
  bool ran_yesterday_ = true;
};

}  // namespace

EffectKind early_start() {
  return {
      .id = "early_start",
      .title = "Plant starts too early",
      .group = EffectClass::schedules,
      .sentence =
          "Air handlers start well before the planned hour, earliest on cold mornings and after "
          "weekends: fans and heating are up at night while nobody is in yet.",
      .strength = {0.0, 3.0, 5.0, "hours earlier than planned when it is 5 degC outside"},
      .needs = {.timetable = true},
      .turns = "fan hours in the morning",
      .make = make_effect<EarlyStart>};
}

}  // namespace recald::simulators
