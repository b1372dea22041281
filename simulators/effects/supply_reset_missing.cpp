#include <algorithm>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

/// Supply air should be warmer in winter. Instead someone fixed its set-point for one warm room:
/// first the reset is lost, and then the fixed value is even colder.
class SupplyResetMissing final : public EffectWithSettings {
 public:
  SupplyResetMissing(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), sensor_C_(kSensorLag_s) {}

  void operate(const Moment& now, Operation& operation) override {
    const double outdoor_C = sensor_C_.follow(now.outdoors.air.temperature_C, now.step_s);
    if (!settings_.covers(now.local.date)) return;
    AirOperation& air = operation.air;
    air.supply_reset_share *= 1.0 - std::min(1.0, settings_.strength / kFullyLost_K);
    air.supply_shift_K -= 0.5 * settings_.strength * ramp(outdoor_C, 18.0, 5.0);
  }

 private:
  static constexpr double kSensorLag_s = 1800.0;
  static constexpr double kFullyLost_K = 3.0;

  SlowValue sensor_C_;
};

}  // namespace

EffectKind supply_reset_missing() {
  return {.id = "supply_reset_missing",
          .title = "Supply air stays cold in winter",
          .group = EffectClass::air_system,
          .sentence =
              "Air handlers blow cold air all winter instead of warming it up a few degrees: the "
              "rooms have to heat it again, and the cooling runs in cold weather.",
          .strength = {0.0, 4.0, 6.0, "K colder in winter than intended"},
          .needs = {.heat_meter = true},
          .turns = "supply temperature",
          .make = make_effect<SupplyResetMissing>};
}

}  // namespace recald::simulators
