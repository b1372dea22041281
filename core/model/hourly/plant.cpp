#include "core/model/hourly/plant.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace recald::model::hourly {
namespace {

constexpr double kWarmestWaterDay = 230.0;  // day of year, cold-water mains lag the air
constexpr double kWaterHeat_kWh_m3K = 1.163;
constexpr double kIdleOverLoad = 10.0;  ///< A tenth of its idle power's worth keeps a plant on.

}  // namespace

Plant::Plant(const Building& building)
    : heating_((1.0 + building.heating_loss_fraction) / building.heating_efficiency),
      cooling_(1.0 + building.cooling_loss_fraction),
      hot_water_(1.0 / (building.hot_water.efficiency * building.heating_efficiency)),
      chiller_(building.chiller_cop ? 1.0 / *building.chiller_cop : 0.0),
      idle_W_(building.chiller_cop ? 1000.0 * building.cooling_idle_kW : 0.0) {}

EndUsePower_W Plant::metered_W(const StepLoads& loads) const {
  EndUsePower_W power_W;
  const auto set = [&](EndUse use, double value_W) {
    power_W[static_cast<Eigen::Index>(use)] = value_W;
  };
  const double heating = heating_ * loads.heating_cost_factor;
  const double chilled_W = cooling_ * (loads.sensible_cooling_W + loads.latent_cooling_W);
  const double district = chiller_ > 0.0 ? cooling_ : cooling_ * loads.cooling_cost_factor;
  set(EndUse::lighting, loads.lights_W);
  set(EndUse::plugs, loads.plugs_W);
  set(EndUse::exterior, loads.exterior_W);
  set(EndUse::fans, loads.fans_W);
  set(EndUse::pumps, loads.pumps_W);
  const double compressor_W = chiller_ * chilled_W * loads.cooling_cost_factor;
  // In an hour that asks for less, the plant runs for a part of it.
  const double idle_W = std::min(idle_W_, kIdleOverLoad * chiller_ * chilled_W);
  set(EndUse::chiller, compressor_W + idle_W);
  set(EndUse::sensible_cooling, district * loads.sensible_cooling_W);
  set(EndUse::latent_cooling, district * loads.latent_cooling_W);
  set(EndUse::zone_heating, heating * loads.zone_heating_W);
  set(EndUse::reheat, heating * loads.reheat_W);
  set(EndUse::preheat, heating * loads.preheat_W);
  set(EndUse::humidification, heating * loads.humidification_W);
  set(EndUse::hot_water, hot_water_ * loads.heating_cost_factor * loads.hot_water_W);
  set(EndUse::base_heat, loads.base_heat_W);
  return power_W;
}

double hot_water_W(const HotWater& water, int day_of_year) {
  const double mains_C =
      water.mains_C + water.mains_amplitude_K * std::cos(2.0 * std::numbers::pi *
                                                         (day_of_year - kWarmestWaterDay) / 365.0);
  return 1000.0 / 24.0 * kWaterHeat_kWh_m3K * water.volume_m3_day * (water.temperature_C - mains_C);
}

}  // namespace recald::model::hourly
