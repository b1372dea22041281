#include <algorithm>

#include "simulators/climate/air.hpp"
#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

/// In warm spells the fans flush the building with cool night air, so that the slabs are
/// cold in the morning.
class NightPurge final : public EffectWithSettings {
 public:
  NightPurge(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), warmth_C_(kDay_s) {}

  void operate(const Moment& now, Operation& operation) override {
    const Outdoors& outdoors = now.outdoors;
    const double outdoor_C = outdoors.air.temperature_C;
    const bool warm_spell = warm_spell_.update(warmth_C_.follow(outdoor_C, now.step_s));
    const bool cool_night = cool_.update(-outdoor_C);
    // Do not bring in moisture that the coils must remove the next day.
    const double dew_C =
        dew_point_C(vapour_pressure_Pa(outdoors.air.humidity_kg_kg, outdoors.pressure_Pa));
    const bool night = now.hour() >= kFrom_h || now.hour() < kTo_h;
    if (!night || !warm_spell || !cool_night || dew_C > kDampest_C) return;
    if (!settings_.covers(now.local.date)) return;
    operation.air.purge_share = std::max(operation.air.purge_share, settings_.strength);
  }

 private:
  static constexpr double kFrom_h = 22.0;
  static constexpr double kTo_h = 6.0;
  static constexpr double kDampest_C = 16.0;

  SlowValue warmth_C_;                 ///< Of the last day.
  Hysteresis warm_spell_{16.0, 18.0};  ///< Of the last day, degC.
  Hysteresis cool_{-22.0, -20.5};      ///< Minus outdoors: on below 20.5 degC, off above 22 degC.
};

}  // namespace

EffectKind night_purge() {
  return {.id = "night_purge",
          .title = "Flushed with night air",
          .group = EffectClass::outside_catalogue,
          .sentence =
              "In warm weather the fans flush the building with cool outdoor air at night: fan "
              "electricity at night rises, and cooling on the next morning falls.",
          .strength = {0.0, 0.6, 1.0, "share of the full air flow"},
          .needs = {.timetable = true},
          .turns = "night flushing",
          .make = make_effect<NightPurge>};
}

}  // namespace recald::simulators
