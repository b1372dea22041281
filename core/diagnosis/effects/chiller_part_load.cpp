/// The building's own chiller is worse at part load, or in warm weather, than one COP says.
#include <algorithm>

#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"
#include "core/weather/psychrometrics.hpp"

namespace recald::diagnosis::effects {
namespace {

constexpr double kLatentAllowance = 1.3;  // of a sensible design load, usual in offices
constexpr double kDesign_W_m2 = 100.0;    // used without an air system that gives the design load
constexpr double kLeastLoad = 0.1;        // below, the chiller cycles at this load
constexpr double kReferenceCondenser_C = 30.0;
constexpr double kTowerApproach_K = 5.0;
constexpr double kLeastCondenser_C = 20.0;

double design_cooling_W(const SiteFacts& facts) {
  const model::Building& building = facts.building;
  if (!building.air) return kDesign_W_m2 * building.floor_area_m2;
  const double drop_K = building.set_points.cooling_occupied_C - building.air->supply_temperature_C;
  return kLatentAllowance * weather::air_heat_capacity_J_m3K(facts.drivers.pressure_Pa) *
         building.air->supply_flow_design_m3_s * std::max(drop_K, 5.0);
}

}  // namespace

Effect chiller_part_load() {
  return {
      .id = "chiller_part_load",
      .title = "Chiller inefficient at part load",
      .meaning =
          "The chiller uses more electricity per unit of cooling when it is lightly loaded or "
          "its condenser is warm. Check staging, minimum load and the tower.",
      .physics =
          "power = cooling/COP x (1 + p (1/r - 1)) x (1 + c (T_cw - 30 C)); r load over "
          "design load, at least 0.1; T_cw = max(T_out + 5 K, 20 C); p in -, c in 1/K",
      .on_meters =
          "Electricity rises more than chilled water on mild days and in warm weather; other "
          "meters stay the same.",
      .check = "The staging, the minimum load and the condenser water of the chiller.",
      .effect_class = EffectClass::plant,
      .dating = Dating::may_begin,
      .needs = {.own_chiller = true},
      .confusable = {{"fouling",
                      "Chiller power at one load and tower temperature, this year and last."},
                     {"constant_flow_pumps", "The pump power alone, on a mild working day."},
                     {"demand_limit",
                      "Chiller power plotted against its load on the hottest afternoons."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "idle_power_share",
                 .unit = "-",
                 .prior = half_normal_below(0.15, 0.6),
                 .neutral = 0.0},
                {.name = "condenser_slope",
                 .unit = "1/K",
                 .prior = half_normal_below(0.02, 0.06),
                 .neutral = 0.0}};
      },
      // Two separable parts of the entry's quadratic curve: a share of the power that does not
      // follow the load, and more expensive cooling when the condenser is warm. Its overall factor
      // is the nominal COP, a calibration parameter.
      .bind =
          [](const SiteFacts& facts, Values values, int) {
            return supplying(
                [idle_share = values[0], per_K = values[1], design_W = design_cooling_W(facts)](
                    const model::Building&, const DriverHour&, const StepOperation& operation,
                    StepLoads& loads) {
                  const double load_W = loads.sensible_cooling_W + loads.latent_cooling_W;
                  const double ratio = std::clamp(load_W / design_W, kLeastLoad, 1.0);
                  // Outdoor air stands for the tower's water, which follows it from about 15 C up.
                  const double condenser_C =
                      std::max(operation.dry_bulb_C + kTowerApproach_K, kLeastCondenser_C);
                  loads.cooling_cost_factor *= 1.0 + idle_share * (1.0 / ratio - 1.0);
                  loads.cooling_cost_factor *= 1.0 + per_K * (condenser_C - kReferenceCondenser_C);
                });
          },
  };
}

}  // namespace recald::diagnosis::effects
