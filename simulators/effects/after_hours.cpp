#include <algorithm>
#include <array>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// Air handlers run into the evening: cleaners and people working overtime press the override
/// button, and sometimes nobody resets it.
class AfterHours final : public EffectWithSettings {
 public:
  using EffectWithSettings::EffectWithSettings;

  void plan(metering::Day day, Timetable& timetable) override {
    // Monday to Friday. All factors together average 1.
    constexpr std::array evenings{1.0, 1.1, 1.1, 1.1, 0.7};
    const double mood = settings_.rng.uniform(0.5, 1.4);
    const bool forgotten = settings_.rng.uniform() < 0.03;
    RunningHours& air = timetable.air;
    if (!settings_.covers(day) || timetable.kind != DayKind::workday) return;
    if (air.from_h >= air.to_h) return;
    const unsigned weekday = std::chrono::weekday{std::chrono::sys_days{day}}.iso_encoding() - 1;
    const double factor = forgotten ? 2.5 : mood * evenings[std::min(weekday, 4U)];
    air.to_h = std::max(air.to_h, std::min(24.0, air.to_h + settings_.strength * factor));
  }
};

}  // namespace

EffectKind after_hours() {
  return {.id = "after_hours",
          .title = "Plant runs on in the evening",
          .group = EffectClass::schedules,
          .sentence =
              "Air handlers are switched off hours later than planned on most working days: fans, "
              "cooling and heating go on into the evening when people have left.",
          .strength = {0.0, 3.0, 6.0, "hours later than planned, on an average working day"},
          .needs = {.timetable = true},
          .turns = "fan hours in the evening",
          .make = make_effect<AfterHours>};
}

}  // namespace recald::simulators
