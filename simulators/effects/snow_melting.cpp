#include <algorithm>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

constexpr double kAfterRun_s = 3.0 * 3600.0;  ///< Until the last puddle has dried.
constexpr double kKeepWarm = 0.25;            ///< Of full power, in dry frost.
constexpr double kRampShare = 0.75;           ///< Of the power; gutters and drains use the rest.

/// A garage ramp, gutters and drains that are kept free of ice: full heating in snow, low heating
/// in dry frost. Hot water or steam heats the ramp if the plant has it; gutters are electric.
class SnowMelting final : public EffectWithSettings {
 public:
  SnowMelting(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        full_W_(settings.strength * drawings.floor_area_m2()),
        heat_share_(drawings.heating == HeatingPlant::heat_pump ? 0.0 : kRampShare),
        frost_(/*off_below=*/-1.0, /*on_above=*/1.0) {}

  void operate(const Moment& now, Operation& operation) override {
    on_share_ = sense(now);
    if (!settings_.covers(now.local.date)) return;
    operation.plant.heating_standing_W += heat_share_ * full_W_ * on_share_;
  }

  void load(const Moment& now, ServiceLoad& load) override {
    if (!settings_.covers(now.local.date)) return;
    load.other_electricity_W += (1.0 - heat_share_) * full_W_ * on_share_;
  }

 private:
  double sense(const Moment& now) {
    const Outdoors& outdoors = now.outdoors;
    const double air_C = outdoors.air.temperature_C;
    const bool freezing = frost_.update(1.5 - air_C);  // on below 0.5 degC, off above 2.5
    const bool falling = outdoors.precipitation_mm_h > 0.05 && air_C < 2.0;
    const bool lying = outdoors.snow_cover_mm > 0.5 && air_C < 2.0;
    to_run_s_ = falling || lying ? kAfterRun_s : std::max(0.0, to_run_s_ - now.step_s);
    return to_run_s_ > 0.0 ? 1.0 : freezing ? kKeepWarm : 0.0;
  }

  double full_W_;
  double heat_share_;
  Hysteresis frost_;
  double to_run_s_ = 0.0;
  double on_share_ = 0.0;
};

}  // namespace

EffectKind snow_melting() {
  return {
      .id = "snow_melting",
      .title = "Ramp and gutters heated in snow",
      .group = EffectClass::outside_catalogue,
      .sentence =
          "A ramp and gutters are kept free of snow and ice: heat and electricity jump up on days "
          "of snow and frost, at night as well.",
      .strength = {0.0, 6.0, 15.0, "W/m² of the building's floor"},
      .turns = "ramp heating",
      .make = make_effect<SnowMelting>};
}

}  // namespace recald::simulators
