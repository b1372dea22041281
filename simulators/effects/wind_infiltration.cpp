#include <array>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

constexpr double kOpenDoor = 2.5;  ///< Opening during a delivery relative to the permanent gap.
constexpr std::size_t kDeliveries = 6;  ///< Per working day.

/// A loading door with worn seals, and a facade that is not much tighter. The door is open
/// during deliveries.
class WindInfiltration final : public EffectWithSettings {
 public:
  WindInfiltration(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings) {
    const double facades_m2 = 2.0 * (drawings.length_m + drawings.width_m) *
                              static_cast<double>(drawings.storeys) * drawings.storey_height_m;
    gap_m2_ = settings.strength * facades_m2 / 1000.0;
    for (double& share : side_share_) share = settings_.rng.uniform(0.05, 0.20);
    door_side_ = settings_.rng.below(side_share_.size());
    side_share_[door_side_] = 1.0;
  }

  void plan(metering::Day /*day*/, Timetable& timetable) override {
    for (RunningHours& delivery : deliveries_) {
      delivery.from_h = settings_.rng.uniform(6.5, 16.0);
      delivery.to_h = delivery.from_h + settings_.rng.uniform(0.1, 0.6);
    }
    workday_ = timetable.kind == DayKind::workday;
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    for (std::size_t side = 0; side < side_share_.size(); ++side) {
      operation.envelope.opening_m2[side] += side_share_[side] * gap_m2_;
    }
    if (door_open(now.hour())) operation.envelope.opening_m2[door_side_] += kOpenDoor * gap_m2_;
  }

 private:
  [[nodiscard]] bool door_open(double hour) const {
    if (!workday_) return false;
    for (const RunningHours& delivery : deliveries_) {
      if (hour >= delivery.from_h && hour < delivery.to_h) return true;
    }
    return false;
  }

  double gap_m2_ = 0.0;
  std::array<double, 4> side_share_{};  ///< Of the gap, by facade.
  std::size_t door_side_ = 0;
  std::array<RunningHours, kDeliveries> deliveries_{};
  bool workday_ = false;
};

}  // namespace

EffectKind wind_infiltration() {
  return {.id = "wind_infiltration",
          .title = "Wind blows in",
          .group = EffectClass::envelope,
          .sentence =
              "A loading door and its facade are leaky, and wind blows in: heating, and cooling in "
              "summer, rise on windy days, most with wind from one side.",
          .strength = {0.0, 0.2, 3.0, "m² of gap for each 1000 m² of facade"},
          .turns = "wind leak",
          .make = make_effect<WindInfiltration>};
}

}  // namespace recald::simulators
