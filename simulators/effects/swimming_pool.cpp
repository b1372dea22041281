#include <algorithm>
#include <chrono>

#include "simulators/chance/chance.hpp"
#include "simulators/climate/air.hpp"
#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

constexpr double kPool_C = 28.0;
constexpr double kMains_C = 12.0;
constexpr AirState kHall{30.0, 0.0145};  ///< Above the water's temperature, at 54 % humidity.
constexpr double kOpenEvaporation_kg_m2h = 0.20;
constexpr double kCoveredEvaporation_kg_m2h = 0.03;
constexpr double kMostAir_kg_s_m2 = 0.012;  ///< Capacity of the hall's fans, per pool area.
constexpr double kLeastDrying_kg_kg = 0.003;
constexpr double kHeatRecovered = 0.5;
constexpr double kDryerLift_J_J = 3.0;   ///< Evaporation heat removed per electricity of the dryer.
constexpr double kHallLoss_W_m2K = 3.0;  ///< Through the hall's glass and roof, per pool area.
constexpr double kShowers_W_m2 = 40.0;   ///< While open, on a day of average crowd.
constexpr double kPumps_W_m2 = 18.0;     ///< Filters run day and night.
constexpr double kFansAndLamps_W_m2 = 30.0;
constexpr double kRefilled_m = 0.06;  ///< Of the water's depth, after Monday's filter washing.
constexpr RunningHours kRefill{6.0, 18.0};

/// A pool: closed on Mondays for filter washing and new water, open on other days, covered at
/// night. Its hall is dried with outdoor air while that is dry, otherwise with a dehumidifier.
class SwimmingPool final : public EffectWithSettings {
 public:
  SwimmingPool(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        pool_m2_(settings.strength * drawings.floor_area_m2() / 1000.0) {}

  void plan(metering::Day day, Timetable& /*timetable*/) override {
    const std::chrono::weekday weekday{std::chrono::sys_days{day}};
    crowd_ = Triangular{0.6, 1.0, 1.4}.draw(settings_.rng);
    const bool weekend = weekday == std::chrono::Saturday || weekday == std::chrono::Sunday;
    monday_ = weekday == std::chrono::Monday;
    open_ = monday_   ? RunningHours{24.0, 0.0}
            : weekend ? RunningHours{9.0, 18.0}
                      : RunningHours{7.0, 21.0};
  }

  void operate(const Moment& now, Operation& operation) override {
    demand_ = demand(now);
    if (!settings_.covers(now.local.date)) return;
    operation.plant.heating_standing_W += pool_m2_ * demand_.heat_W_m2;
  }

  void load(const Moment& now, ServiceLoad& load) override {
    if (!settings_.covers(now.local.date)) return;
    load.other_electricity_W += pool_m2_ * demand_.electricity_W_m2;
  }

 private:
  /// Per water area.
  struct Demand {
    double heat_W_m2 = 0.0;
    double electricity_W_m2 = 0.0;
  };

  [[nodiscard]] static bool within(const RunningHours& hours, double hour) {
    return hour >= hours.from_h && hour < hours.to_h;
  }

  [[nodiscard]] Demand demand(const Moment& now) const {
    const bool open = within(open_, now.hour());
    const double evaporated_kg_s_m2 =
        (open ? kOpenEvaporation_kg_m2h * crowd_ : kCoveredEvaporation_kg_m2h) / 3600.0;
    const AirState& outdoors = now.outdoors.air;
    const double drying_kg_kg =
        std::max(kLeastDrying_kg_kg, kHall.humidity_kg_kg - outdoors.humidity_kg_kg);
    const double air_kg_s_m2 = std::min(kMostAir_kg_s_m2, evaporated_kg_s_m2 / drying_kg_kg);
    const double carried_kg_s_m2 = std::clamp(
        air_kg_s_m2 * (kHall.humidity_kg_kg - outdoors.humidity_kg_kg), 0.0, evaporated_kg_s_m2);
    const double colder_K = std::max(0.0, kHall.temperature_C - outdoors.temperature_C);
    const double hall_W_m2 = colder_K * (kHallLoss_W_m2K + (1.0 - kHeatRecovered) * air_kg_s_m2 *
                                                               heat_capacity_J_kgK(outdoors));
    const double showers_W_m2 = open ? kShowers_W_m2 * crowd_ : 0.0;
    const bool refilling = monday_ && within(kRefill, now.hour());
    const double refill_W_m2 = refilling ? 1000.0 * kRefilled_m * kWaterHeat_J_kgK *
                                               (kPool_C - kMains_C) /
                                               (3600.0 * (kRefill.to_h - kRefill.from_h))
                                         : 0.0;
    // Heat from the dryer goes back into the water.
    const double dryer_W_m2 = (evaporated_kg_s_m2 - carried_kg_s_m2) * kEvaporation_J_kg;
    return {carried_kg_s_m2 * kEvaporation_J_kg + hall_W_m2 + showers_W_m2 + refill_W_m2,
            kPumps_W_m2 + (open ? kFansAndLamps_W_m2 : 0.0) + dryer_W_m2 / kDryerLift_J_J};
  }

  double pool_m2_;
  bool monday_ = false;
  RunningHours open_{24.0, 0.0};
  double crowd_ = 1.0;  ///< Today, relative to the average.
  Demand demand_;
};

}  // namespace

EffectKind swimming_pool() {
  return {.id = "swimming_pool",
          .title = "Swimming pool",
          .group = EffectClass::outside_catalogue,
          .sentence =
              "A pool is heated and its hall dried all year, with new water every Monday: heat is "
              "used even in summer and peaks at the start of the week, and electricity is higher.",
          .strength = {0.0, 10.0, 30.0, "m² of water for each 1000 m² of floor"},
          .turns = "pool",
          .make = make_effect<SwimmingPool>};
}

}  // namespace recald::simulators
