#include "simulators/building/district_service.hpp"

#include <algorithm>
#include <cmath>

#include "simulators/climate/air.hpp"
#include "simulators/climate/weather.hpp"

namespace recald::simulators {

DistrictService::DistrictService(const Truth& truth, Rng rng)
    : truth_(truth), rng_(rng), taps_(1800.0, kStep_s, rng_) {}

double DistrictService::hot_water_W(double people_share) {
  using namespace drawings;
  // Glass washers and hand basins: most of the day's water while people are in.
  const double daily_shape = 0.25 + 2.4 * people_share;
  const double taps = std::max(0.0, 1.0 + 0.45 * taps_.advance(rng_));
  const double flow_kg_s = truth_.hot_water_m3_day * 1000.0 / 86'400.0 * daily_shape * taps;
  return flow_kg_s * kWaterHeat_J_kgK * (hot_water_C - mains_C) / hot_water_efficiency;
}

double DistrictService::pumps_W(const ServiceLoad& load) const {
  constexpr double chilled_water_design_W = 900e3;
  constexpr double hot_water_design_W = 700e3;
  const auto variable_speed = [](double part_load) {
    return 0.18 + 0.82 * std::pow(std::min(1.0, part_load), 2.2);
  };
  return 1000.0 * truth_.pump_kW *
         (0.65 * variable_speed(load.cooling_W / chilled_water_design_W) +
          0.35 * variable_speed(load.heating_W / hot_water_design_W));
}

UtilityPower DistrictService::advance(const ServiceLoad& load) {
  const double pumps_W_now = pumps_W(load);
  const double exterior_W = load.dark ? 1000.0 * truth_.exterior_kW : 0.0;
  const double pump_heat_W = 0.65 * 0.8 * pumps_W_now;
  const double heating_W = load.heating_W + hot_water_W(load.people_share);
  return {
      (load.lights_and_plugs_W + load.fans_W + pumps_W_now + exterior_W) / 1000.0,
      (load.cooling_W * (1.0 + truth_.chilled_water_loss_share) + pump_heat_W) / 1000.0 +
          truth_.chilled_water_standing_kW,
      heating_W / truth_.steam_efficiency / 1000.0 + truth_.steam_standing_kW,
  };
}

}  // namespace recald::simulators
