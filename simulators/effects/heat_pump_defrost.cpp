#include <algorithm>

#include "simulators/climate/air.hpp"
#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

constexpr double kCoilBelowAir_K = 7.0;
/// In the cold the heat pump gives less, and its coil is closer to the air temperature.
constexpr double kCoilFollows_K_K = 0.15;
constexpr double kCoilLeastBelowAir_K = 4.0;
constexpr double kWorstFrosting_kg_kg = 0.0017;  ///< At about 3 degC in fog.
constexpr double kCycle_s = 3600.0;              ///< From clear to fully iced, at worst.
/// Penalty at full ice; and a defrost costs this many seconds of full penalty. Together they
/// average a penalty of 1 over a cycle at worst.
constexpr double kIcedUp = 0.4;
constexpr double kDefrost_s = 0.8 * kCycle_s;

/// The outdoor coil of the heat pump ices up in damp air near freezing, and is defrosted
/// with its own heat.
class HeatPumpDefrost final : public EffectWithSettings {
 public:
  using EffectWithSettings::EffectWithSettings;

  void operate(const Moment& now, Operation& operation) override {
    double penalty = 0.0;
    if (ice_ >= 1.0) {
      penalty = kDefrost_s / now.step_s;
      ice_ = 0.0;
    } else if (runs_) {
      ice_ += frosting(now.outdoors) * now.step_s / kCycle_s;
      penalty = kIcedUp * std::min(1.0, ice_);
    }
    if (!settings_.covers(now.local.date)) return;
    operation.plant.heat_pump_cop_factor /= 1.0 + settings_.strength * penalty;
  }

  void load(const Moment& /*now*/, ServiceLoad& load) override { runs_ = load.heating_W > 0.0; }

 private:
  /// About 1 at worst: water that settles on the coil when it is below freezing and
  /// below the dew point.
  [[nodiscard]] static double frosting(const Outdoors& outdoors) {
    const double air_C = outdoors.air.temperature_C;
    const double coil_C = air_C - std::clamp(kCoilBelowAir_K + kCoilFollows_K_K * (air_C - 3.0),
                                             kCoilLeastBelowAir_K, kCoilBelowAir_K);
    const double frozen_share = ramp(coil_C, 0.0, -3.0);
    const double settling_kg_kg =
        outdoors.air.humidity_kg_kg - saturation_humidity_kg_kg(coil_C, outdoors.pressure_Pa);
    return frozen_share * std::max(0.0, settling_kg_kg) / kWorstFrosting_kg_kg;
  }

  double ice_ = 0.0;  ///< 1: iced up.
  bool runs_ = false;
};

}  // namespace

EffectKind heat_pump_defrost() {
  return {
      .id = "heat_pump_defrost",
      .title = "Heat pump ices up",
      .group = EffectClass::plant,
      .sentence =
          "In damp weather near freezing the heat pump ices up and thaws itself with its own "
          "heat: electricity rises then, more than it does in dry frost.",
      .strength = {0.0, 0.6, 2.0, "share more electricity of the heat pump in the worst weather"},
      .needs = {.heat_pump = true},
      .turns = "heat pump",
      .make = make_effect<HeatPumpDefrost>};
}

}  // namespace recald::simulators
