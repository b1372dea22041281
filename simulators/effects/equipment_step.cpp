#include <algorithm>
#include <chrono>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

constexpr double kStandingShare = 0.55;  ///< Of new equipment: the part that runs day and night.
constexpr double kLampsMin = 0.1;        ///< Of the lamps' power, even after a thorough retrofit.

/// From one date on there is more equipment (a laboratory or computers moved in) or less (better
/// lamps). The change takes some days.
class EquipmentStep final : public EffectWithSettings {
 public:
  EquipmentStep(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        floor_m2_(drawings.floor_area_m2()),
        lamps_W_m2_(installed_lamps_W_m2(drawings)),
        roll_out_days_(settings_.rng.uniform(2.0, 15.0)) {}

  void plan(metering::Day day, Timetable& /*timetable*/) override {
    if (!settings_.covers(day)) return;
    days_in_ += 1.0;
    share_in_ = std::min(1.0, days_in_ / roll_out_days_);
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    const double change_W_m2 = settings_.strength * share_in_;
    if (change_W_m2 < 0.0) {
      operation.rooms.lights_factor *= std::max(kLampsMin, 1.0 + change_W_m2 / lamps_W_m2_);
    } else {
      const double in_use = kStandingShare + (1.0 - kStandingShare) * now.people_share;
      operation.rooms.extra_plugs_W += change_W_m2 * floor_m2_ * in_use;
    }
  }

 private:
  [[nodiscard]] static double installed_lamps_W_m2(const Drawings& drawings) {
    double storey_W = 0.0;
    double storey_m2 = 0.0;
    for (std::size_t side = south; side <= special; ++side) {
      storey_W += drawings.zone_m2(side) * drawings.rooms(side).lighting_W_m2;
      storey_m2 += drawings.zone_m2(side);
    }
    return storey_W / storey_m2;
  }

  double floor_m2_;
  double lamps_W_m2_;
  double roll_out_days_;
  double days_in_ = 0.0;
  double share_in_ = 0.0;
};

}  // namespace

EffectKind equipment_step() {
  return {.id = "equipment_step",
          .title = "New equipment or retrofit",
          .group = EffectClass::electrical,
          .sentence =
              "From one date on there is new equipment, or lamps were changed for better ones: "
              "electricity steps up or down and stays there, and the heat in the rooms with it.",
          .strength = {-6.0, 3.0, 10.0, "W/m² of floor, negative for better lamps"},
          .turns = "plugs",
          .dated = true,
          .make = make_effect<EquipmentStep>};
}

}  // namespace recald::simulators
