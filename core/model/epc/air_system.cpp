#include "core/model/epc/air_system.hpp"

#include <algorithm>

namespace recald::model::epc {
namespace {

/// Share of outdoor air in the supply. Below the lock-out, an economiser opens as far as the supply
/// temperature requires.
double outdoor_air_share(const AirSystem& system, double minimum_share, double return_C,
                         double outdoor_C) {
  if (!system.economiser_lockout_C || outdoor_C >= *system.economiser_lockout_C ||
      outdoor_C >= return_C) {
    return minimum_share;
  }
  const double wanted = (return_C - system.supply_temperature_C) / (return_C - outdoor_C);
  return std::clamp(wanted, minimum_share, 1.0);
}

}  // namespace

double fan_power_share(double r) { return 0.0013 + r * (0.1470 + r * (0.9506 - r * 0.0998)); }

BoxRates box_rates(const BoxLimits& limits, double heat_capacity_J_m3K, const ZoneDemand& demand) {
  const double lift_K = std::max(demand.cooling_set_point_C - limits.supply_C, 0.1);
  const double dead_band_K = demand.cooling_set_point_C - demand.heating_set_point_C;
  BoxRates rates{};
  rates.flow_m3_s = std::clamp(demand.cooling_load_W / (heat_capacity_J_m3K * lift_K),
                               limits.least_m3_s, limits.most_m3_s);
  const double flow_W_K = heat_capacity_J_m3K * rates.flow_m3_s;

  // Cooling beyond the load; negative if even design flow is not enough.
  const double surplus_W = flow_W_K * lift_K - demand.cooling_load_W + demand.shortage_W;
  const double total_W_K = demand.conductance_W_K + flow_W_K;
  const double drop_K = std::clamp(surplus_W / total_W_K, 0.0, dead_band_K);
  rates.heating_W = std::max(surplus_W - drop_K * total_W_K, 0.0);
  rates.zone_C = demand.cooling_set_point_C - drop_K;
  return rates;
}

HandlerRates handler_rates(const AirSystem& system, double heat_capacity_J_m3K,
                           double running_share, double supply_m3_s, double return_C,
                           double outdoor_C) {
  const double supply_C = system.supply_temperature_C;
  HandlerRates rates{};
  rates.outdoor_air_share = outdoor_air_share(
      system, std::min(system.outdoor_air_m3_s / supply_m3_s, 1.0), return_C, outdoor_C);
  const double incoming_C = outdoor_C + system.heat_recovery * (return_C - outdoor_C);
  const double mixed_C = return_C + rates.outdoor_air_share * (incoming_C - return_C);

  const double power_share =
      running_share * fan_power_share(supply_m3_s / system.supply_flow_design_m3_s);
  rates.fan_W = 1000.0 * system.fan_design_kW * power_share;
  rates.pump_W = 1000.0 * system.pump_design_kW * power_share;

  // The fan's heat enters the air stream: the coil removes it, or it saves preheat.
  const double to_supply_W =
      heat_capacity_J_m3K * running_share * supply_m3_s * (mixed_C - supply_C) + rates.fan_W;
  rates.coil_W = std::max(to_supply_W, 0.0);
  rates.preheat_W = std::max(-to_supply_W, 0.0);
  return rates;
}

}  // namespace recald::model::epc
