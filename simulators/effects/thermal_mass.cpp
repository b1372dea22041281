#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// Raised floors and suspended ceilings separate the slabs from the rooms, or concrete
/// was left exposed.
class ThermalMass final : public HiddenEffect {
 public:
  ThermalMass(const EffectSettings& settings, const Drawings& /*drawings*/)
      : strength_(settings.strength) {}

  void build(Truth& truth) const override { truth.mass_scale *= 1.0 + strength_; }

 private:
  double strength_;
};

}  // namespace

EffectKind thermal_mass() {
  return {
      .id = "thermal_mass",
      .title = "Lighter or heavier than drawn",
      .group = EffectClass::envelope,
      .sentence =
          "The building stores less heat than drawn, or more: rooms cool down and warm up faster "
          "or slower at night, which shows in the hours after switching on and in peaks.",
      .strength = {-0.75, -0.6, 1.5, "share of the heat capacity, negative for less"},
      .needs = {.timetable = true},
      .turns = "mass",
      .make = make_effect<ThermalMass>};
}

}  // namespace recald::simulators
