#include <algorithm>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// A weekly programme that someone copied to Saturday, and then to Sunday too. Holidays in the week
/// are a separate list of exceptions, so they do not change.
class WeekendOperation final : public EffectWithSettings {
 public:
  WeekendOperation(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        workday_air_{drawings.occupied_from_h, drawings.occupied_to_h} {}

  void plan(metering::Day day, Timetable& timetable) override {
    const bool runs = timetable.air.from_h < timetable.air.to_h;
    if (timetable.kind == DayKind::workday && runs) workday_air_ = timetable.air;
    const double share = settings_.covers(day) ? share_of_workday(day) : 0.0;
    if (share <= 0.0) return;
    if (!runs) {
      const double length_h = workday_air_.to_h - workday_air_.from_h;
      timetable.air = {workday_air_.from_h, workday_air_.from_h + share * length_h};
      timetable.warm_up_h *= share;
      return;
    }
    RunningHours& air = timetable.air;  // a Saturday has its own hours
    air.from_h -= share * std::max(0.0, air.from_h - workday_air_.from_h);
    air.to_h += share * std::max(0.0, workday_air_.to_h - air.to_h);
  }

 private:
  [[nodiscard]] double share_of_workday(metering::Day day) const {
    const std::chrono::weekday weekday{std::chrono::sys_days{day}};
    if (weekday == std::chrono::Saturday) return std::clamp(settings_.strength, 0.0, 1.0);
    if (weekday == std::chrono::Sunday) return std::clamp(settings_.strength - 1.0, 0.0, 1.0);
    return 0.0;
  }

  RunningHours workday_air_;  ///< Of the last working day.
};

}  // namespace

EffectKind weekend_operation() {
  return {
      .id = "weekend_operation",
      .title = "Plant runs on weekends",
      .group = EffectClass::schedules,
      .sentence =
          "Air handlers run on Saturdays, or on Saturdays and Sundays, as if these were working "
          "days: fans, cooling and heating show weekday use while the building is empty.",
      .strength = {0.0, 2.0, 2.0, "weekend days a week that run like working days"},
      .needs = {.timetable = true},
      .turns = "fan hours on weekends",
      .make = make_effect<WeekendOperation>};
}

}  // namespace recald::simulators
