#include "core/model/hourly/air_handlers.hpp"

#include <algorithm>

#include "core/model/epc/air_system.hpp"
#include "core/weather/psychrometrics.hpp"

namespace recald::model::hourly {
namespace {

using weather::kAirHeatCapacity_J_kgK;
using weather::kVaporisationHeat_J_kg;

constexpr double kNightLift_K = 1.0;

/// Share of outdoor air in the supply. Below the lock-out, an economiser opens as far as the supply
/// temperature, before the fan's heat, requires.
double outdoor_air_share(const StepOperation& operation, double least_share, double return_C,
                         double fan_rise_K) {
  const double outdoor_C = operation.dry_bulb_C;
  if (outdoor_C >= operation.economiser_lockout_C || outdoor_C >= return_C) return least_share;
  const double wanted = (return_C - (operation.supply_C - fan_rise_K)) / (return_C - outdoor_C);
  const double extra = std::clamp(wanted, least_share, 1.0) - least_share;
  return least_share + operation.economiser_share * extra;
}

/// Share of the hour and of the fans that bring heat to rooms whose handlers are off by schedule.
/// They run the whole hour once the rooms need what the least flow carries at a difference of one
/// kelvin.
double night_share(const AirSystem& air, double heat_capacity_J_m3K, double running_share,
                   double heating_W) {
  const double whole_W = heat_capacity_J_m3K * air.supply_flow_min_m3_s * kNightLift_K;
  const double hour_share = whole_W > 0.0 ? std::min(heating_W / whole_W, 1.0) : 0.0;
  return air.night_fan_share * (1.0 - running_share) * hour_share;
}

/// Handlers that are off by schedule and are called to maintain a night set-point.
void add_on_call(const AirSystem& air, const ZoneTotals& zones, double heat_capacity_J_m3K,
                 const StepOperation& operation, StepLoads& loads) {
  const double flow_m3_s = zones.on_call_W_K / heat_capacity_J_m3K;
  const double power_share = flow_m3_s / air.supply_flow_design_m3_s;
  const double fan_W = 1000.0 * air.fan_design_kW * power_share;
  loads.fans_W += fan_W;
  loads.pumps_W += 1000.0 * air.pump_design_kW * power_share;
  loads.sensible_cooling_W +=
      std::max(zones.on_call_return_W - zones.on_call_W_K * operation.supply_C, 0.0) + fan_W;
  loads.supply_m3_s += flow_m3_s;
}

}  // namespace

void add_air_handlers(const AirSystem& air, double heat_capacity_J_m3K, double running_share,
                      const ZoneTotals& zones, double latent_W, const StepOperation& operation,
                      StepLoads& loads) {
  loads.zone_heating_W = zones.zone_heating_W;
  loads.reheat_W = zones.reheat_W;
  loads.running_share = running_share;
  if (air.night_fan_share > 0.0) {
    const double share = night_share(air, heat_capacity_J_m3K, running_share, zones.zone_heating_W);
    loads.fans_W += 1000.0 * air.fan_design_kW * share;
    // They draw in outdoor air where dampers do not close.
    loads.zone_heating_W += share * operation.outdoor_share_min * heat_capacity_J_m3K *
                            air.supply_flow_min_m3_s *
                            std::max(zones.mean_air_C - operation.dry_bulb_C, 0.0);
  }
  if (zones.on_call_W_K > 0.0) add_on_call(air, zones, heat_capacity_J_m3K, operation, loads);
  if (running_share <= 0.0 || zones.scheduled_W_K <= 0.0) return;

  const double supply_m3_s = zones.scheduled_W_K / heat_capacity_J_m3K;
  const double return_C = zones.scheduled_return_W / zones.scheduled_W_K;
  const double flow_ratio = supply_m3_s / (running_share * air.supply_flow_design_m3_s);
  const double variable = epc::fan_power_share(flow_ratio);
  const double slowing = (1.0 - air.fan_idle_share) * (1.0 - operation.constant_fan_share);
  const double fan_W =
      1000.0 * air.fan_design_kW * running_share * (1.0 - slowing * (1.0 - variable));
  const double outdoor_share =
      outdoor_air_share(operation,
                        std::clamp(operation.outdoor_air_m3_s * running_share / supply_m3_s,
                                   operation.outdoor_share_min, 1.0),
                        return_C, fan_W / zones.scheduled_W_K);
  const double incoming_C =
      operation.dry_bulb_C + air.heat_recovery * (return_C - operation.dry_bulb_C);
  const double mixed_C = return_C + outdoor_share * (incoming_C - return_C);

  loads.fans_W += fan_W;
  loads.pumps_W += 1000.0 * air.pump_design_kW * running_share * variable;
  loads.supply_m3_s += supply_m3_s;

  // The fan's heat enters the air stream: the coil removes it, or it saves preheat.
  const double to_supply_W = zones.scheduled_W_K * (mixed_C - operation.supply_C) + fan_W;
  loads.sensible_cooling_W += std::max(to_supply_W, 0.0);
  loads.preheat_W = std::max(-to_supply_W, 0.0);

  // Only the recirculated part of the people's moisture meets the coil; a coil without a
  // sensible load is dry.
  const double outdoor_W = heat_capacity_J_m3K / kAirHeatCapacity_J_kgK * kVaporisationHeat_J_kg *
                           outdoor_share * supply_m3_s;
  if (to_supply_W > 0.0) {
    const double moisture_W =
        outdoor_W * (operation.humidity_ratio - operation.coil_humidity_ratio) +
        (1.0 - outdoor_share) * running_share * latent_W;
    loads.latent_cooling_W = operation.latent_share * std::max(moisture_W, 0.0);
  }
  loads.humidification_W =
      outdoor_W * std::max(operation.humidifier_kg_kg - operation.humidity_ratio, 0.0);
}

void add_room_units(const AirSystem& air, double lift_K, double heat_capacity_J_m3K,
                    double running_share, const ZoneTotals& zones, double latent_W,
                    const StepOperation& operation, StepLoads& loads) {
  const double outdoor_m3_s = running_share * operation.outdoor_air_m3_s;
  const double design_W = std::max(heat_capacity_J_m3K * air.supply_flow_design_m3_s * lift_K, 1.0);

  double cooling_W = zones.cooling_W;
  if (operation.dry_bulb_C < operation.economiser_lockout_C) {
    const double spare_m3_s =
        std::max(running_share * air.supply_flow_design_m3_s - outdoor_m3_s, 0.0);
    const double free_W = heat_capacity_J_m3K * spare_m3_s * operation.economiser_share *
                          std::max(zones.mean_air_C - operation.dry_bulb_C, 0.0);
    cooling_W -= std::min(free_W, cooling_W);
  }
  const double load_share = std::min(std::max(cooling_W, zones.zone_heating_W) / design_W, 1.0);
  loads.running_share = running_share;
  loads.supply_m3_s = running_share * air.supply_flow_design_m3_s;
  loads.zone_heating_W = zones.zone_heating_W;
  loads.sensible_cooling_W = cooling_W;
  loads.fans_W = 1000.0 * air.fan_design_kW * (running_share + (1.0 - running_share) * load_share);
  loads.pumps_W = 1000.0 * air.pump_design_kW * load_share;

  const double kg_W_per_W_K = kVaporisationHeat_J_kg / kAirHeatCapacity_J_kgK;
  const double outdoor_W = heat_capacity_J_m3K * kg_W_per_W_K * outdoor_m3_s;
  const double coil_W = kg_W_per_W_K * cooling_W / lift_K;
  if (cooling_W > 0.0) {
    const double moisture_W =
        outdoor_W * (operation.humidity_ratio - operation.coil_humidity_ratio) + latent_W;
    loads.latent_cooling_W =
        operation.latent_share * std::max(moisture_W, 0.0) * coil_W / (outdoor_W + coil_W);
  }
  loads.humidification_W =
      outdoor_W * std::max(operation.humidifier_kg_kg - operation.humidity_ratio, 0.0);
}

}  // namespace recald::model::hourly
