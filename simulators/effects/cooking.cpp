#include <algorithm>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

/// A canteen kitchen: cooks in the morning, serves at noon, then washes up. It uses gas if the
/// building has any. The hood removes the heat, and air from the rooms with it.
class Cooking final : public EffectWithSettings {
 public:
  Cooking(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        with_gas_(drawings.heating == HeatingPlant::boiler),
        full_house_(drawings.floor_area_m2() * drawings.occupancy_person_m2) {}

  void plan(metering::Day day, Timetable& timetable) override {
    const double appetite = settings_.rng.uniform(0.85, 1.15);
    const bool opens = timetable.kind == DayKind::workday;
    const bool friday = std::chrono::weekday{std::chrono::sys_days{day}} == std::chrono::Friday;
    guests_share_ = opens ? timetable.attendance * appetite * (friday ? 0.8 : 1.0) : 0.0;
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date) || guests_share_ <= 0.0) return;
    // Hoods run as long as the kitchen is staffed, however many guests there are.
    const bool staffed = now.hour() >= kCook_h && now.hour() < kCleaned_h;
    const double meals_planned = settings_.strength * full_house_;
    if (staffed) operation.envelope.extraction_m3_s += kHood_m3_s_meal * meals_planned;
  }

  void load(const Moment& now, ServiceLoad& load) override {
    if (!settings_.covers(now.local.date)) return;
    const double meals = settings_.strength * full_house_ * guests_share_;
    const double flames_W = meals * kMeal_J * kFlameShare * cooking_per_s(now.hour());
    const double machines_W = meals * kMeal_J * (1.0 - kFlameShare) * washing_per_s(now.hour());
    (with_gas_ ? load.other_fuel_W : load.other_electricity_W) += flames_W;
    load.other_electricity_W += machines_W;
  }

 private:
  static constexpr double kMeal_J = 2.0 * 3600e3;   ///< 2 kWh in total for a cooked lunch.
  static constexpr double kFlameShare = 0.7;        ///< The rest: dishwashers, ovens, warm plates.
  static constexpr double kHood_m3_s_meal = 0.008;  ///< 30 m³/h for each lunch.
  static constexpr double kCook_h = 8.0;
  static constexpr double kServe_h = 11.0;
  static constexpr double kLastGuest_h = 13.5;
  static constexpr double kCleaned_h = 15.0;

  /// Flames rise from 8 to 11 h, stay until the last guest and then go down: worth 1.5 +
  /// 2.5 + 0.5 hours.
  [[nodiscard]] static double cooking_per_s(double hour) {
    constexpr double full_hours = 4.5;
    const double shape =
        ramp(hour, kCook_h, kServe_h) * ramp(hour, kLastGuest_h + 1.0, kLastGuest_h);
    return shape / (full_hours * 3600.0);
  }
  /// Machines start with the first plates: worth 0.5 + 2.5 + 0.25 hours.
  [[nodiscard]] static double washing_per_s(double hour) {
    constexpr double full_hours = 3.25;
    const double shape =
        ramp(hour, kServe_h, kServe_h + 1.0) * ramp(hour, kCleaned_h, kCleaned_h - 0.5);
    return shape / (full_hours * 3600.0);
  }

  bool with_gas_;
  double full_house_;          ///< Number of people when everybody is there.
  double guests_share_ = 0.0;  ///< Today.
};

}  // namespace

EffectKind cooking() {
  return {
      .id = "cooking",
      .title = "Canteen kitchen",
      .group = EffectClass::outside_catalogue,
      .sentence =
          "A kitchen that is not in the drawings cooks lunch on working days: gas (electricity, "
          "where there is no gas) peaks before noon, whatever the weather.",
      .strength = {0.0, 0.3, 1.0, "lunches for each person of the building on a working day"},
      .turns = "kitchen",
      .make = make_effect<Cooking>};
}

}  // namespace recald::simulators
