#include <algorithm>
#include <array>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// People choose their days at home, and choose similar ones.
class HybridWork final : public EffectWithSettings {
 public:
  using EffectWithSettings::EffectWithSettings;

  void plan(metering::Day day, Timetable& timetable) override {
    constexpr std::array at_home{0.65, 0.15, 0.05, 0.2, 0.85, 0.0, 0.0};  // Monday to Sunday
    const double mood = 1.0 + 0.15 * settings_.rng.normal();
    if (!settings_.covers(day)) return;
    const unsigned weekday = std::chrono::weekday{std::chrono::sys_days{day}}.iso_encoding() - 1;
    timetable.attendance *=
        1.0 - settings_.strength * std::clamp(at_home[weekday] * mood, 0.0, 1.0);
  }
};

}  // namespace

EffectKind hybrid_work() {
  return {
      .id = "hybrid_work",
      .title = "Days at home",
      .group = EffectClass::schedules,
      .sentence =
          "Many people work at home on Mondays and Fridays: lights and plugs are lower on these "
          "days than in the middle of the week.",
      .strength = {0.0, 0.8, 1.0, "share of the people who choose their days"},
      .turns = "attendance",
      .make = make_effect<HybridWork>};
}

}  // namespace recald::simulators
