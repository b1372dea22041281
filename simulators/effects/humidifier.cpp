#include <algorithm>

#include "simulators/climate/air.hpp"
#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

/// Steam keeps the rooms from getting dry in the heating season. It is switched on and off with the
/// season, and is off on days when its cylinders are descaled.
class Humidifier final : public EffectWithSettings {
 public:
  Humidifier(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), warmth_C_(kSeasonMemory_s) {}

  void plan(metering::Day /*day*/, Timetable& /*timetable*/) override {
    in_service_ = settings_.rng.uniform() > 1.0 / kDaysBetweenServices;
  }

  void operate(const Moment& now, Operation& operation) override {
    const double warmth_C = warmth_C_.follow(now.outdoors.air.temperature_C, now.step_s);
    const bool heating_season = season_.update(-warmth_C);
    if (!heating_season || !in_service_ || !settings_.covers(now.local.date)) return;
    const double saturated_kg_kg =
        saturation_humidity_kg_kg(operation.rooms.heating_C, now.outdoors.pressure_Pa);
    double& target_kg_kg = operation.air.humidify_to_kg_kg;
    target_kg_kg = std::max(target_kg_kg, settings_.strength / 100.0 * saturated_kg_kg);
  }

 private:
  static constexpr double kSeasonMemory_s = 3.0 * 86'400.0;
  static constexpr double kDaysBetweenServices = 35.0;

  SlowValue warmth_C_;               ///< Of the last days.
  Hysteresis season_{-15.0, -11.0};  ///< Minus that: on below 11 degC, off above 15 degC.
  bool in_service_ = true;
};

}  // namespace

EffectKind humidifier() {
  return {.id = "humidifier",
          .title = "Rooms are humidified in winter",
          .group = EffectClass::air_system,
          .sentence =
              "Steam is blown into the supply air in winter so that rooms do not get dry: heat use "
              "rises with the dryness of the outdoor air, most on cold clear days.",
          .strength = {0.0, 40.0, 60.0, "% relative humidity that is held in winter"},
          .needs = {.heat_meter = true},
          .turns = "humidifier",
          .make = make_effect<Humidifier>};
}

}  // namespace recald::simulators
