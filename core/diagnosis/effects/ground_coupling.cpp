/// Basement walls and slab lose heat to ground whose temperature lags the seasons.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/absent.hpp"
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {
namespace {

constexpr double kPerDay = 2.0 * std::numbers::pi / 365.0;  // rad
constexpr double kLongEnough_hours = 300.0 * 24.0;          // to separate mean and swing

/// The yearly wave of the outdoor air: mean - swing cos(2 pi (day - coldest) / 365).
struct YearlyWave {
  double mean_C;
  double swing_K;
  double coldest_day;
};

/// Least squares over the record; a record too short to show the wave gets a typical one.
YearlyWave wave_of(const SiteFacts& facts) {
  const auto& hours = facts.drivers.hours;
  if (static_cast<double>(hours.size()) < kLongEnough_hours) {
    return {.mean_C = facts.building.ground_temperature_C, .swing_K = 10.0, .coldest_day = 20.0};
  }
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const DriverHour& hour : hours) {
    const double angle = kPerDay * hour.day_of_year;
    const Eigen::Vector3d row{1.0, std::cos(angle), std::sin(angle)};
    normal += row * row.transpose();
    right += row * hour.dry_bulb_C;
  }
  const Eigen::Vector3d fit = normal.ldlt().solve(right);
  return {.mean_C = fit[0],
          .swing_K = std::hypot(fit[1], fit[2]),
          .coldest_day = std::atan2(-fit[2], -fit[1]) / kPerDay};
}

double ground_W_K(const model::Building& building) {
  double total_W_K = 0.0;
  for (const model::Surface& surface : building.surfaces) {
    if (surface.kind == model::SurfaceKind::ground) total_W_K += surface.area_m2 * surface.u_W_m2K;
  }
  return total_W_K;
}

double footprint_m2(const model::Building& building) {
  return building.floor_area_m2 / std::max(building.storeys, 1);
}

/// Widens the model's own path to the ground, so that the exchange follows the rooms. The path then
/// leads to the mean of both ground temperatures, weighted by their conductances.
class GroundCoupling final : public Alteration {
 public:
  GroundCoupling(const SiteFacts& facts, double conductance_W_K, double lag_days)
      : conductance_W_K_(conductance_W_K),
        drawn_W_K_(ground_W_K(facts.building)),
        wave_(wave_of(facts)),
        lag_days_(lag_days) {}

  void rebuild(model::Building& building) const override {
    if (drawn_W_K_ == 0.0) {
      if (conductance_W_K_ > 0.0) add_slab(building);
      return;
    }
    for (model::Surface& surface : building.surfaces) {
      if (surface.kind == model::SurfaceKind::ground) {
        surface.u_W_m2K *= 1.0 + conductance_W_K_ / drawn_W_K_;
      }
    }
  }

  void operate(const DriverHour& hour, StepOperation& operation) const override {
    if (conductance_W_K_ == 0.0) return;  // without any path to the ground this would be 0/0
    const double weight = conductance_W_K_ / (drawn_W_K_ + conductance_W_K_);
    operation.ground_C += weight * (ground_C(hour.day_of_year) - operation.ground_C);
  }

 private:
  /// In a half-infinite solid a wave that lags by an angle is damped by exp(-angle), so the
  /// amplitude, free in the entry, follows from its lag.
  double ground_C(int day_of_year) const {
    const double damped_K = wave_.swing_K * std::exp(-kPerDay * lag_days_);
    return wave_.mean_C -
           damped_K * std::cos(kPerDay * (day_of_year - wave_.coldest_day - lag_days_));
  }

  void add_slab(model::Building& building) const {
    const double area_m2 = footprint_m2(building);
    building.surfaces.push_back({.name = "slab",
                                 .kind = model::SurfaceKind::ground,
                                 .area_m2 = area_m2,
                                 .u_W_m2K = conductance_W_K_ / area_m2,
                                 .orientation = {}});
  }

  double conductance_W_K_;
  double drawn_W_K_;
  YearlyWave wave_;
  double lag_days_;
};

}  // namespace

Effect ground_coupling() {
  return {
      .id = "ground_coupling",
      .title = "Heat lost to the ground",
      .meaning =
          "Basement walls or the slab lose heat to the soil, which stays cold long into spring.",
      .physics =
          "Q = H_g (T_in - T_g), T_g = mean - A exp(-2 pi lag/365) cos(2 pi (day - "
          "coldest - lag)/365); H_g in W/K, lag in days, A swing of the outdoor air, K",
      .on_meters = "Heat is higher in spring than in autumn at the same outdoor temperature.",
      .check =
          "The insulation of basement walls and slab, and the temperature of basement rooms in "
          "April.",
      .effect_class = EffectClass::envelope,
      .dating = Dating::may_begin,
      .confusable =
          {{"damper_stuck_open",
            "Heating in a warm April week: losses to the ground still need it, an open damper does "
            "not."},
           {"seasonal_hot_water",
            "The hot-water sub-meter, or steam on a summer weekend without hot-water use."},
           {"stack_infiltration",
            "Compare heating in spring and in autumn at the same outdoor temperature."}},
      .parameters = [](const SiteFacts& facts) -> Parameters {
        // 0.3 W/(m2 K): a basement without insulation.
        return {
            {.name = "ground_conductance",
             .unit = "W/K",
             .prior = half_normal(0.3 * footprint_m2(facts.building)),
             .neutral = 0.0},
            {.name = "ground_lag",
             .unit = "d",
             .prior = TruncatedNormalPrior{.location = 40.0, .sd = 20.0, .min = 0.0, .max = 120.0},
             .neutral = kAbsent,
             .scan = {20.0, 40.0, 70.0}}};
      },
      .bind = [](const SiteFacts& facts, Values values, int) -> Altered {
        return std::make_unique<GroundCoupling>(facts, values[0], values[1]);
      },
  };
}

}  // namespace recald::diagnosis::effects
