#include <algorithm>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

/// Carbon-dioxide sensors throttle the outdoor air to the number of people present. The gas builds
/// up and decays with the room air, so the dampers lag behind the people.
class DemandVentilation final : public EffectWithSettings {
 public:
  DemandVentilation(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), measured_people_(kRoomAirChange_s) {}

  void operate(const Moment& now, Operation& operation) override {
    const double people = measured_people_.follow(now.people_share, now.step_s);
    if (!settings_.covers(now.local.date)) return;
    const double need = kFloorShare + (1.0 - kFloorShare) * std::min(1.0, people / kFullHouse);
    operation.air.outdoor_factor *= 1.0 - settings_.strength * (1.0 - need);
  }

 private:
  static constexpr double kRoomAirChange_s = 2400.0;
  static constexpr double kFullHouse = 0.75;   ///< Present / assigned at full outdoor air.
  static constexpr double kFloorShare = 0.25;  ///< For emissions of floors and furniture.

  SlowValue measured_people_;
};

}  // namespace

EffectKind demand_ventilation() {
  return {.id = "demand_ventilation",
          .title = "Outdoor air follows the people",
          .group = EffectClass::outdoor_air,
          .sentence =
              "Carbon-dioxide sensors cut the outdoor air when few people are in, although the "
              "drawings say constant: heating and cooling are lower early, late and on quiet days.",
          .strength = {0.0, 0.9, 1.0, "share of the outdoor air that the sensors control"},
          .turns = "outdoor-air amount",
          .make = make_effect<DemandVentilation>};
}

}  // namespace recald::simulators
