#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// Flow in the shaft with closed landing doors, relative to open ones.
constexpr double kDoorsClosedShare = 0.75;
constexpr double kWedgedDays = 0.6;  ///< Share of working days on which the doors are wedged open.

/// A stairwell whose smoke vent at the top does not close: a chimney in cold weather.
class StackInfiltration final : public EffectWithSettings {
 public:
  StackInfiltration(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        shaft_m2_(settings.strength * drawings.floor_area_m2() / 1000.0) {}

  void plan(metering::Day /*day*/, Timetable& timetable) override {
    const bool wedged = settings_.rng.uniform() < kWedgedDays;
    const double from_h = settings_.rng.uniform(6.5, 8.5);
    const double to_h = settings_.rng.uniform(16.0, 19.0);
    doors_open_ = wedged && timetable.kind == DayKind::workday ? RunningHours{from_h, to_h}
                                                               : RunningHours{24.0, 0.0};
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    const bool open = now.hour() >= doors_open_.from_h && now.hour() < doors_open_.to_h;
    operation.envelope.shaft_m2 += shaft_m2_ * (open ? 1.0 : kDoorsClosedShare);
  }

 private:
  double shaft_m2_;
  RunningHours doors_open_{24.0, 0.0};
};

}  // namespace

EffectKind stack_infiltration() {
  return {.id = "stack_infiltration",
          .title = "Stairwell open at the top",
          .group = EffectClass::envelope,
          .sentence =
              "A vent at the top of a stairwell does not close: in cold weather warm air leaves "
              "there and cold air follows below, so heating rises the more the colder it is.",
          .strength = {0.0, 0.05, 0.4, "m² of open shaft for each 1000 m² of floor"},
          .turns = "stack leak",
          .make = make_effect<StackInfiltration>};
}

}  // namespace recald::simulators
