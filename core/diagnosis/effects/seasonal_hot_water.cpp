/// More hot water, from mains that are cold in winter, through a loop that loses heat all year.
#include <cmath>
#include <numbers>

#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {
namespace {

constexpr double kWarmestWaterDay = 230.0;              // as in the models' own cold water
constexpr double kWater_W_per_m3_dayK = 1163.0 / 24.0;  // rho c of a steady draw
constexpr double kUsualLift_K = 45.0;                   // from the mains to the tap

}  // namespace

Effect seasonal_hot_water() {
  return {
      .id = "seasonal_hot_water",
      .title = "More hot water than in the drawings",
      .meaning =
          "More hot water is used than the drawings say. Heating it takes more in winter, when the "
          "mains water is cold, and the circulation loop loses heat day and night.",
      .physics =
          "Q = V rho c a + M d (1 + a/45 K) + L, a = -A cos(2 pi (day - 230)/365); V drawn use in "
          "m3/s, M mean heat of the use beside it in kW, d use of the hour over its mean, A half "
          "the yearly swing of the mains in K, L loop loss in kW before efficiencies",
      .on_meters =
          "Heat is higher all year and more so in winter, with the hours of hot-water use; chilled "
          "water stays the same.",
      .check =
          "The hot-water sub-meter and the circulation loop: its pump, its insulation, its use in "
          "summer.",
      .effect_class = EffectClass::plant,
      .dating = Dating::may_begin,
      .confusable = {{"steam_trap_leak",
                      "Steam on an August night with the circulation pump stopped for an hour."},
                     {"ground_coupling", "The hot-water sub-meter, or steam on a summer weekend."},
                     {"humidifier",
                      "Compare steam on damp and on dry cold days at the same temperature."}},
      .parameters = [](const SiteFacts& facts) -> Parameters {
        // Taps and loop about alike: little is lost at a time, but day and night.
        const double share_kW = share_of_mean_kW(facts, metering::Utility::heating, 0.06);
        return {
            {.name = "more_use", .unit = "kW", .prior = half_normal(share_kW), .neutral = 0.0},
            {.name = "mains_swing",
             .unit = "K",
             .prior = half_normal_below(8.0, 20.0),
             .neutral = 0.0},
            {.name = "loop_loss", .unit = "kW", .prior = half_normal(share_kW), .neutral = 0.0}};
      },
      .bind =
          [](const SiteFacts&, Values values, int) {
            return supplying([more_kW = values[0], swing_K = values[1], loop_loss_kW = values[2]](
                                 const model::Building& building, const DriverHour& hour,
                                 const StepOperation&, StepLoads& loads) {
              const double angle =
                  2.0 * std::numbers::pi * (hour.day_of_year - kWarmestWaterDay) / 365.0;
              const double colder_K = -swing_K * std::cos(angle);
              const double drawn_W_K = kWater_W_per_m3_dayK * building.hot_water.volume_m3_day;
              const double more_W = 1e3 * more_kW * (1.0 + colder_K / kUsualLift_K);
              loads.hot_water_W += loads.hot_water_litres_share * (drawn_W_K * colder_K + more_W);
              loads.hot_water_W += 1e3 * loop_loss_kW;
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
