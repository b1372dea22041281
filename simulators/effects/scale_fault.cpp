#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/meter_slots.hpp"

namespace recald::simulators {
namespace {

/// A wrong pulse weight or transformer ratio, since someone replaced the meter or
/// changed its settings.
class ScaleFault final : public EffectWithSettings {
 public:
  using EffectWithSettings::EffectWithSettings;

  void distort(const MeterRecord& record) const override {
    if (settings_.meter != record.utility) return;
    const SlotRange covered = covered_slots(record, settings_);
    for (std::size_t slot = covered.first; slot < covered.last; ++slot) {
      record.shown_kW[slot] *= 1.0 + settings_.strength;
    }
  }
};

}  // namespace

EffectKind scale_fault() {
  return {
      .id = "scale_fault",
      .title = "Meter reads by a wrong factor",
      .group = EffectClass::meters,
      .sentence =
          "From one date on the meter's readings are multiplied by a wrong factor: everything it "
          "shows is too high or too low by the same share, while the building runs as before.",
      .strength = {-0.6, 0.25, 1.0, "share above what is right, negative for below"},
      .turns = "what the meter shows",
      .dated = true,
      .of_one_meter = true,
      .make = make_effect<ScaleFault>};
}

}  // namespace recald::simulators
