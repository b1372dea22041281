#include <algorithm>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// Drives are in bypass: the boxes throttle, but the fans keep running at full speed.
class ConstantSpeedFans final : public HiddenEffect {
 public:
  ConstantSpeedFans(const EffectSettings& settings, const Drawings& /*drawings*/)
      : settings_(settings) {}

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    operation.air.fan_follows_flow *= std::max(0.0, 1.0 - settings_.strength);
  }

 private:
  EffectSettings settings_;
};

}  // namespace

EffectKind constant_speed_fans() {
  return {.id = "constant_speed_fans",
          .title = "Fans do not slow down",
          .group = EffectClass::air_system,
          .sentence =
              "Fans run at full speed whenever they run, however little air the rooms ask for: "
              "electricity is high on mild days, and the fans' heat has to be cooled.",
          .strength = {0.0, 1.0, 1.0, "share of the fans that do not slow down"},
          .turns = "fan speed",
          .make = make_effect<ConstantSpeedFans>};
}

}  // namespace recald::simulators
