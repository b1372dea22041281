#include <algorithm>

#include "simulators/chance/chance.hpp"
#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

/// More lamps outside than drawn. A photocell switches them on at dusk, a little earlier under
/// clouds; some lamps are always broken.
class ExteriorLighting final : public EffectWithSettings {
 public:
  ExteriorLighting(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        lamps_W_(settings.strength * drawings.floor_area_m2()),
        daylight_(/*off_below=*/8.0, /*on_above=*/20.0),
        repair_(30.0 * kDay_s, kDay_s, settings_.rng) {}

  void plan(metering::Day /*day*/, Timetable& /*timetable*/) override {
    lit_share_ = std::clamp(0.95 + 0.03 * repair_.advance(settings_.rng), 0.85, 1.0);
  }

  void load(const Moment& now, ServiceLoad& load) override {
    const bool daylight = daylight_.update(now.outdoors.global_horizontal_W_m2);
    if (daylight || !settings_.covers(now.local.date)) return;
    load.other_electricity_W += lamps_W_ * lit_share_;
  }

 private:
  double lamps_W_;
  Hysteresis daylight_;  ///< On horizontal radiation, W/m².
  Persistence repair_;
  double lit_share_ = 1.0;
};

}  // namespace

EffectKind exterior_lighting() {
  return {
      .id = "exterior_lighting",
      .title = "More lamps outside",
      .group = EffectClass::electrical,
      .sentence =
          "More lamps burn outside from dusk to dawn than drawn: electricity is higher at night, "
          "longest in winter, and heating and cooling do not notice.",
      .strength = {0.0, 1.5, 6.0, "W/m² of the building's floor"},
      .turns = "exterior lights",
      .make = make_effect<ExteriorLighting>};
}

}  // namespace recald::simulators
