#include "simulators/building/cooling_coil.hpp"

#include <algorithm>
#include <cmath>

namespace recald::simulators {
namespace {

double bypass_factor(const CoolingCoil& coil, double flow_kg_s) {
  const double design_ntu = -std::log(coil.design_bypass_factor);
  return std::exp(-design_ntu * std::sqrt(coil.design_flow_kg_s / flow_kg_s));
}

CoilWork work_between(const AirState& entering, const AirState& leaving, double flow_kg_s) {
  const double condensate_kg_s = flow_kg_s * (entering.humidity_kg_kg - leaving.humidity_kg_kg);
  // The condensate leaves at the temperature of the leaving air and carries its own heat.
  const double drained_W = condensate_kg_s * kWaterHeat_J_kgK * leaving.temperature_C;
  const double total_W = flow_kg_s * (enthalpy_J_kg(entering) - enthalpy_J_kg(leaving)) - drained_W;
  const double sensible_W =
      flow_kg_s * heat_capacity_J_kgK(entering) * (entering.temperature_C - leaving.temperature_C);
  return {leaving, total_W, sensible_W, condensate_kg_s};
}

}  // namespace

CoilWork cool(const CoolingCoil& coil, const AirState& entering, double flow_kg_s, double target_C,
              double pressure_Pa) {
  if (flow_kg_s <= 0.0 || entering.temperature_C <= target_C) return {entering, 0.0, 0.0, 0.0};
  const double bypass = bypass_factor(coil, flow_kg_s);
  const double wanted_fins_C = (target_C - bypass * entering.temperature_C) / (1.0 - bypass);
  const double fins_C = std::max(wanted_fins_C, coil.lowest_apparatus_dew_point_C);
  if (fins_C >= entering.temperature_C) return {entering, 0.0, 0.0, 0.0};
  const double fins_humidity =
      std::min(entering.humidity_kg_kg, saturation_humidity_kg_kg(fins_C, pressure_Pa));
  const AirState leaving{bypass * entering.temperature_C + (1.0 - bypass) * fins_C,
                         bypass * entering.humidity_kg_kg + (1.0 - bypass) * fins_humidity};
  const CoilWork full = work_between(entering, leaving, flow_kg_s);
  if (full.total_W <= coil.capacity_W) return full;
  // At full capacity: stay on the same coil line, short of its end. Enthalpy is linear along it
  // except for terms of second order.
  const double reach = coil.capacity_W / full.total_W;
  const AirState short_of{
      entering.temperature_C + reach * (leaving.temperature_C - entering.temperature_C),
      entering.humidity_kg_kg + reach * (leaving.humidity_kg_kg - entering.humidity_kg_kg)};
  return work_between(entering, short_of, flow_kg_s);
}

}  // namespace recald::simulators
