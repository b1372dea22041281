#include <algorithm>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// Pumps set to "hand": full speed day and night, winter and summer.
class ConstantFlowPumps final : public HiddenEffect {
 public:
  ConstantFlowPumps(const EffectSettings& settings, const Drawings& /*drawings*/)
      : settings_(settings) {}

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    operation.plant.pumps_follow_load *= std::max(0.0, 1.0 - settings_.strength);
  }

 private:
  EffectSettings settings_;
};

}  // namespace

EffectKind constant_flow_pumps() {
  return {.id = "constant_flow_pumps",
          .title = "Pumps do not slow down",
          .group = EffectClass::air_system,
          .sentence =
              "Water pumps run at full speed all year, whatever the load: electricity is higher by "
              "a nearly constant amount, most at night and in mild weather.",
          .strength = {0.0, 1.0, 1.0, "share of the pumps that do not slow down"},
          .turns = "pump speed",
          .make = make_effect<ConstantFlowPumps>};
}

}  // namespace recald::simulators
