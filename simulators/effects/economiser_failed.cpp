#include <algorithm>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// Free cooling is switched off, or some of the air handlers' dampers do not move.
class EconomiserFailed final : public HiddenEffect {
 public:
  EconomiserFailed(const EffectSettings& settings, const Drawings& /*drawings*/)
      : settings_(settings) {}

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    operation.air.economiser_share *= std::max(0.0, 1.0 - settings_.strength);
  }

 private:
  EffectSettings settings_;
};

}  // namespace

EffectKind economiser_failed() {
  return {.id = "economiser_failed",
          .title = "Free cooling does not happen",
          .group = EffectClass::outdoor_air,
          .sentence =
              "The dampers do not open for free cooling in cool weather: chilled water is used in "
              "spring, autumn and winter although outdoor air could cool the building.",
          .strength = {0.0, 1.0, 1.0, "share of the free cooling that is lost"},
          .needs = {.cooling_meter = true, .economiser = true},
          .turns = "economiser",
          .make = make_effect<EconomiserFailed>};
}

}  // namespace recald::simulators
