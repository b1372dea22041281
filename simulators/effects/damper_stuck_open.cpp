#include <algorithm>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// The outdoor-air damper's linkage slips: the blades stay open wherever the actuator is. After
/// each repair they stick in a slightly different position.
class DamperStuckOpen final : public EffectWithSettings {
 public:
  DamperStuckOpen(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), position_(settings_.rng.uniform(kLeast, kMost)) {}

  void plan(metering::Day /*day*/, Timetable& /*timetable*/) override {
    const bool worked_on = settings_.rng.uniform() < 1.0 / kDaysBetweenVisits;
    const double position = settings_.rng.uniform(kLeast, kMost);
    if (worked_on) position_ = position;
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    double& share = operation.air.damper_leak_share;
    share = std::min(1.0, share + settings_.strength * position_);
  }

 private:
  static constexpr double kLeast = 0.85;
  static constexpr double kMost = 1.15;
  static constexpr double kDaysBetweenVisits = 90.0;

  double position_;  ///< Relative to the strength.
};

}  // namespace

EffectKind damper_stuck_open() {
  return {.id = "damper_stuck_open",
          .title = "Outdoor-air damper stuck open",
          .group = EffectClass::outdoor_air,
          .sentence =
              "The outdoor-air damper does not close: outdoor air comes in whenever a fan turns, "
              "also at night and while rooms are warmed up, and must be heated or cooled.",
          .strength = {0.0, 0.4, 0.9, "share of the supply air that is outdoor air at least"},
          .turns = "outdoor-air damper",
          .make = make_effect<DamperStuckOpen>};
}

}  // namespace recald::simulators
