#include <cmath>

#include "simulators/climate/air.hpp"
#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/yearly_wave.hpp"

namespace recald::simulators {
namespace {

/// Of the mean heat of the drawings' hot water, lost by the pipes of the added taps.
constexpr double kCirculationShare = 0.3;

/// More hot water than drawn (showers, a canteen, dishwashers). Mains water is cold in late winter
/// and mild in late summer, and a circulation pipe stays warm day and night.
class SeasonalHotWater final : public EffectWithSettings {
 public:
  SeasonalHotWater(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), latitude_deg_(drawings.place.latitude_deg) {
    const double flow_kg_s = drawings.hot_water_m3_day * 1000.0 / 86'400.0;
    circulation_W_ = settings.strength * kCirculationShare * flow_kg_s * kWaterHeat_J_kgK *
                     (drawings.hot_water_C - drawings.mains_C);
    swing_K_ = settings_.rng.uniform(5.0, 8.0) * (1.0 - std::exp(-settings.strength));
    coldest_day_ = settings_.rng.uniform(35.0, 65.0);
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    PlantOperation& plant = operation.plant;
    plant.hot_water_factor += settings_.strength;
    plant.heating_standing_W += circulation_W_;
    plant.mains_shift_K += swing_K_ * yearly_wave(now.local.date, coldest_day_, latitude_deg_);
  }

 private:
  double latitude_deg_;
  double circulation_W_;
  double swing_K_;
  double coldest_day_;
};

}  // namespace

EffectKind seasonal_hot_water() {
  return {.id = "seasonal_hot_water",
          .title = "More hot water than drawn",
          .group = EffectClass::plant,
          .sentence =
              "More hot water is used than drawn and its pipe is kept warm all day: heat is used "
              "summer and winter, and more of it while the mains are cold.",
          .strength = {0.0, 1.0, 3.0, "times the drawn hot water, besides it"},
          .needs = {.heat_meter = true},
          .turns = "hot water",
          .make = make_effect<SeasonalHotWater>};
}

}  // namespace recald::simulators
