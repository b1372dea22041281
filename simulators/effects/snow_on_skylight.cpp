#include <algorithm>
#include <cmath>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

constexpr double kOpaque_mm = 3.0;  ///< Water equivalent of snow that blocks most light.
constexpr double kDaylight_lm_W = 110.0;
constexpr double kLamps_lm_W = 85.0;
constexpr double kUseful = 0.25;  ///< Of daylight on the skylight: the part that reaches a desk.
constexpr double kReplaceableShare = 0.4;  ///< Of the core's lamps: dimmed under a bright skylight.

/// Snow covers the skylight: the core is dark and cool, and its lamps come back on.
class SnowOnSkylight final : public EffectWithSettings {
 public:
  SnowOnSkylight(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        skylight_m2_(drawings.skylight_m2()),
        dimmable_W_(kReplaceableShare * drawings.zone_m2(core) *
                    drawings.core_rooms.lighting_W_m2) {}

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    const Outdoors& outdoors = now.outdoors;
    const double taken =
        settings_.strength * (1.0 - std::exp(-outdoors.snow_cover_mm / kOpaque_mm));
    operation.envelope.skylight_factor *= 1.0 - taken;
    const double daylight_as_lamps_W =
        skylight_m2_ * outdoors.global_horizontal_W_m2 * kUseful * kDaylight_lm_W / kLamps_lm_W;
    operation.rooms.extra_lights_W +=
        taken * now.people_share * std::min(dimmable_W_, daylight_as_lamps_W);
  }

 private:
  double skylight_m2_;
  double dimmable_W_;
};

}  // namespace

EffectKind snow_on_skylight() {
  return {
      .id = "snow_on_skylight",
      .title = "Snow on the skylight",
      .group = EffectClass::outside_catalogue,
      .sentence =
          "While snow lies on the skylight the core gets no sun: heating and lights go up until "
          "it has melted.",
      .strength = {0.0, 0.9, 1.0, "share of the light that deep snow takes"},
      .needs = {.skylight = true},
      .turns = "skylight",
      .make = make_effect<SnowOnSkylight>};
}

}  // namespace recald::simulators
