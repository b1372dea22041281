#include <algorithm>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// A tank of ice that the chilled water charges at night and that serves the coils
/// in the afternoon.
class IceStorage final : public EffectWithSettings {
 public:
  IceStorage(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        capacity_J_(settings.strength * 3600e3 * drawings.chilled_water_design_kW),
        least_plant_W_(kLeastPlant * 1000.0 * drawings.chilled_water_design_kW) {}

  void operate(const Moment& now, Operation& operation) override {
    melt_away(now);
    if (!settings_.covers(now.local.date)) return;
    const bool charging_hours = now.hour() >= kChargeFrom_h || now.hour() < kChargeTo_h;
    const bool melting_hours = now.hour() >= kMeltFrom_h && now.hour() < kMeltTo_h;
    double into_W = 0.0;
    if (charging_hours) into_W = charge_W(now);
    if (melting_hours && now.day_kind == DayKind::workday) into_W = -melt_W(now);
    stored_J_ += into_W * now.step_s;
    operation.plant.cooling_shift_W += into_W;
    // Ice needs brine well below freezing, so the chiller has a larger lift.
    const double for_ice = into_W > 0.0 ? into_W / (into_W + last_load_W_ + least_plant_W_) : 0.0;
    operation.plant.chiller_cop_factor *= 1.0 - kIcePenalty * for_ice;
  }

  void load(const Moment& /*now*/, ServiceLoad& load) override { last_load_W_ = load.cooling_W; }

 private:
  static constexpr double kChargeFrom_h = 22.0;
  static constexpr double kChargeTo_h = 6.0;
  static constexpr double kMeltFrom_h = 12.0;
  static constexpr double kMeltTo_h = 18.0;
  static constexpr double kFastestCharge_h = 7.0;  ///< From empty to full.
  static constexpr double kCarriedShare = 0.85;    ///< Of the coils' load, at most.
  static constexpr double kIcePenalty = 0.2;       ///< Of the chiller's performance.
  static constexpr double kLeastPlant = 0.05;      ///< Of the design load: pipes and cycling.
  static constexpr double kThroughWalls_per_day = 0.015;

  void melt_away(const Moment& now) {
    stored_J_ -= stored_J_ * kThroughWalls_per_day * now.step_s / 86'400.0;
  }
  /// At full rate, slower as the tank fills up.
  [[nodiscard]] double charge_W(const Moment& now) const {
    const double fastest_W = capacity_J_ / (kFastestCharge_h * 3600.0);
    return std::min(fastest_W, (capacity_J_ - stored_J_) / std::max(1800.0, now.step_s));
  }
  /// Spread over the remaining hours, as far as the coils can use it.
  [[nodiscard]] double melt_W(const Moment& now) const {
    const double left_s = std::max((kMeltTo_h - now.hour()) * 3600.0, now.step_s);
    return std::min(stored_J_ / left_s, kCarriedShare * last_load_W_);
  }

  double capacity_J_;
  double least_plant_W_;
  double stored_J_ = 0.0;
  double last_load_W_ = 0.0;  ///< Of the coils, in the previous step.
};

}  // namespace

EffectKind ice_storage() {
  return {
      .id = "ice_storage",
      .title = "Cold store",
      .group = EffectClass::outside_catalogue,
      .sentence =
          "A tank is frozen at night and melted in the afternoon: cooling shows on the meter at "
          "night and is missing after noon, the daily sum hardly changes.",
      .strength = {0.0, 2.0, 6.0, "hours of the full cooling capacity that the tank holds"},
      .needs = {.cooling_meter = true},
      .turns = "cold store",
      .make = make_effect<IceStorage>};
}

}  // namespace recald::simulators
