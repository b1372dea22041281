/// How a built instance differs from its drawings. The seed decides it; the site file
/// does not show it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "simulators/building/drawings.hpp"

namespace recald::simulators {

struct Truth {
  Drawings drawings;

  // Parameters that a calibrated model also has, drawn from the user's own priors.
  double occupancy_density_person_m2;  ///< People assigned to the building / floor area.
  double outdoor_airflow_m3_s;         ///< All air handlers ventilating, occupied hours.
  double cooling_setpoint_C;  ///< Occupied, floor-area mean, centre of the throttling band.

  // Other differences.
  double heating_setpoint_C;
  double night_heating_C;
  double night_cooling_C;
  double thermostat_band_K;
  std::vector<double> thermostat_offset_K;  ///< By zone; floor-area mean zero.
  double wall_u_W_m2K;
  double roof_u_W_m2K;
  double ground_u_W_m2K;
  double window_u_W_m2K;
  double window_shgc;
  double blind_transmittance;  ///< Of a lowered blind.
  double leakage_cm2_m2;
  double ground_C;
  double mass_scale = 1.0;  ///< On the heat capacity of slabs, partitions, walls, furniture.
  double occupied_from_h;
  double occupied_to_h;
  bool saturday_operation;  ///< Air handlers with a timetable run from 8 to 14 h on Saturdays.
  std::vector<double> outdoor_m3_s;  ///< By air handler; weighted by storey, they sum to the above.
  std::vector<double> supply_C;      ///< By air handler.
  double supply_reset_K;             ///< Of air handlers with a timetable, in cold weather.
  double core_night_share;
  double box_minimum_scale;
  double fan_scale;
  double fan_exponent;
  double coil_scale;
  double lighting_scale;
  double perimeter_plugs_scale;
  double core_plugs_scale;
  double special_plugs_scale;
  double zone_heat_share;
  double exterior_kW;
  double hot_water_m3_day;
  double chilled_water_loss_share;   ///< Of the load.
  double chilled_water_standing_kW;  ///< Heat that pipes gain, whatever the load.
  double heating_efficiency;         ///< Converter, heat exchanger or boiler at full load.
  double heating_standing_kW;        ///< Traps and pipes.
  double pump_kW;
  double chiller_cop_scale = 1.0;
  double heat_pump_cop_scale = 1.0;
};

[[nodiscard]] Truth draw_truth(const Drawings& drawings, std::uint64_t seed);

}  // namespace recald::simulators
