#include <algorithm>
#include <numeric>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/meter_slots.hpp"

namespace recald::simulators {
namespace {

/// One of three current transformers reads zero. Its phase carries about a third, slightly more by
/// day than by night or the reverse, depending on the wiring.
class PhaseLost final : public EffectWithSettings {
 public:
  PhaseLost(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings) {
    tilt_ = settings_.rng.uniform(-0.12, 0.12);
  }

  void distort(const MeterRecord& record) const override {
    const SlotRange covered = covered_slots(record, settings_);
    if (record.utility != Utility::electricity || covered.count() == 0) return;
    const std::span<double> shown_kW = record.shown_kW.subspan(covered.first, covered.count());
    const double mean_kW = std::accumulate(shown_kW.begin(), shown_kW.end(), 0.0) /
                           static_cast<double>(shown_kW.size());
    if (mean_kW <= 0.0) return;
    for (double& value_kW : shown_kW) {
      const double above_mean = std::clamp(value_kW / mean_kW - 1.0, -1.0, 1.0);
      value_kW *= 1.0 - settings_.strength * (1.0 + tilt_ * above_mean);
    }
  }

 private:
  double tilt_ = 0.0;  ///< How strongly the phase's share depends on the load.
};

}  // namespace

EffectKind phase_lost() {
  return {.id = "phase_lost",
          .title = "One phase of the electricity meter is lost",
          .group = EffectClass::meters,
          .sentence =
              "One of the electricity meter's three current transformers reads nothing since a "
              "date: the meter shows about a third too little, while the building runs as before.",
          .strength = {0.0, 1.0 / 3.0, 1.0 / 3.0, "share lost"},
          .turns = "what the meter shows",
          .dated = true,
          .all_or_nothing = true,
          .make = make_effect<PhaseLost>};
}

}  // namespace recald::simulators
