#include <algorithm>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// Reheat valves that do not shut: dirt keeps some open, while flushing or a new actuator closes
/// others, so the leak varies around its mean over the months.
class SimultaneousHeatingCooling final : public EffectWithSettings {
 public:
  SimultaneousHeatingCooling(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), dirt_(kMonth_s, kDay_s, settings_.rng) {}

  void plan(metering::Day /*day*/, Timetable& /*timetable*/) override {
    dirt_.advance(settings_.rng);
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    const double wander = std::clamp(1.0 + 0.12 * dirt_.value(), 0.7, 1.3);
    double& share = operation.air.reheat_leak_share;
    share = std::min(1.0, share + settings_.strength * wander);
  }

 private:
  static constexpr double kMonth_s = 30.0 * kDay_s;

  Persistence dirt_;
};

}  // namespace

EffectKind simultaneous_heating_cooling() {
  return {.id = "simultaneous_heating_cooling",
          .title = "Heating and cooling at once",
          .group = EffectClass::air_system,
          .sentence =
              "Valves of the room heaters leak while the same air is being cooled: heat is used in "
              "summer, and the cooling has to take it away again.",
          .strength = {0.0, 0.03, 0.2, "share of the heaters' capacity that leaks through"},
          .needs = {.heat_meter = true},
          .turns = "reheat valves",
          .make = make_effect<SimultaneousHeatingCooling>};
}

}  // namespace recald::simulators
