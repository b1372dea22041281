#include <algorithm>

#include "simulators/climate/air.hpp"
#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

/// Some rooms must be dry (archives, instruments): on humid days the coils run colder than the
/// supply set-point requires.
class DeepDrying final : public EffectWithSettings {
 public:
  DeepDrying(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), dry_to_C_(drawings.supply_C - settings.strength) {}

  void operate(const Moment& now, Operation& operation) override {
    const Outdoors& outdoors = now.outdoors;
    const double outdoor_dew_C =
        dew_point_C(vapour_pressure_Pa(outdoors.air.humidity_kg_kg, outdoors.pressure_Pa));
    const bool humid = humid_.update(outdoor_dew_C);
    if (!humid || settings_.strength <= 0.0 || !settings_.covers(now.local.date)) return;
    std::optional<double>& dry_to_C = operation.air.dry_to_C;
    dry_to_C = dry_to_C ? std::min(*dry_to_C, dry_to_C_) : dry_to_C_;
  }

 private:
  double dry_to_C_;
  Hysteresis humid_{12.0, 14.0};  ///< Outdoor dew point, degC.
};

}  // namespace

EffectKind deep_drying() {
  return {.id = "deep_drying",
          .title = "Air is dried further than drawn",
          .group = EffectClass::air_system,
          .sentence =
              "On humid days the air is cooled several degrees further to dry it: cooling rises "
              "with the humidity outside, and the rooms need heat to make up for the colder air.",
          .strength = {0.0, 3.5, 5.0, "K that the dew point lies below the designed supply air"},
          .needs = {.cooling_meter = true},
          .turns = "drying",
          .make = make_effect<DeepDrying>};
}

}  // namespace recald::simulators
