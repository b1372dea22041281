/// Cold mains in winter, and a pipe loop that loses heat all year.
#include <cmath>
#include <numbers>

#include "core/diagnosis/effects/support/meter_priors.hpp"

namespace recald::diagnosis::effects {

Effect seasonal_hot_water();

namespace {

using model::hourly::StepLoads;
using model::hourly::StepOperation;

constexpr double kWarmestWaterDay = 230.0;              // as in the models' own cold water
constexpr double kWater_W_per_m3_dayK = 1163.0 / 24.0;  // rho c of a steady draw

class SeasonalHotWater final : public model::hourly::Alteration {
 public:
  SeasonalHotWater(double swing_K, double loop_loss_kW)
      : swing_K_(swing_K), loop_loss_kW_(loop_loss_kW) {}

  void supply(const model::Building& building, const model::DriverHour& hour, const StepOperation&,
              StepLoads& loads) const override {
    const double angle = 2.0 * std::numbers::pi * (hour.day_of_year - kWarmestWaterDay) / 365.0;
    const double colder_K = -swing_K_ * std::cos(angle);
    loads.hot_water_W += kWater_W_per_m3_dayK * building.hot_water.volume_m3_day *
                         loads.hot_water_litres_share * colder_K;
    loads.hot_water_W += 1e3 * loop_loss_kW_;
  }

 private:
  double swing_K_;
  double loop_loss_kW_;
};

std::vector<EffectParameter> parameters(const SiteFacts& facts) {
  // A tenth of the summer's heat, which is about 1/2.5 of the mean over the year.
  const double loop_loss_kW = share_of_mean_kW(facts, metering::Utility::heating, 0.04);
  return {
      {.name = "mains_swing", .unit = "K", .prior = half_normal_below(8.0, 20.0), .neutral = 0.0},
      {.name = "loop_loss", .unit = "kW", .prior = half_normal(loop_loss_kW), .neutral = 0.0}};
}

std::unique_ptr<model::hourly::Alteration> bind(const SiteFacts&, std::span<const double> values,
                                                int) {
  return std::make_unique<SeasonalHotWater>(values[0], values[1]);
}

}  // namespace

Effect seasonal_hot_water() {
  return {
      .id = "seasonal_hot_water",
      .title = "Hot water: cold mains and loop loss",
      .meaning =
          "Heating tap water takes more heat in winter, when the mains water is cold, and the "
          "circulation loop loses heat day and night.",
      .physics =
          "Q = V rho c (-A cos(2 pi (day - 230)/365)) + L; V draw in m3/s, A half the "
          "yearly swing of the mains in K, L loop loss in kW before efficiencies",
      .effect_class = EffectClass::plant,
      .dating = Dating::may_begin,
      .confusable = {{"steam_trap_leak",
                      "Steam on an August night with the circulation pump stopped for an hour."},
                     {"ground_coupling", "The hot-water sub-meter, or steam on a summer weekend."},
                     {"humidifier",
                      "Compare steam on damp and on dry cold days at the same temperature."}},
      .parameters = parameters,
      .bind = bind};
}

}  // namespace recald::diagnosis::effects
