/// How one built instance differs from its drawings. The seed decides; the site file never knows.
#pragma once

#include <array>
#include <cstdint>

#include "simulators/building/drawings.hpp"

namespace recald::simulators {

struct Truth {
  // What a calibrated model would also call by these names, drawn from the user's own priors.
  double occupancy_density_person_m2;  ///< People assigned to the building / floor area.
  double outdoor_airflow_m3_s;         ///< All air handlers ventilating, occupied hours.
  double cooling_setpoint_C;  ///< Occupied, floor-area mean, centre of the throttling band.

  // What differs besides.
  double heating_setpoint_C;
  double office_night_heating_C;
  double office_night_cooling_C;
  double thermostat_band_K;
  std::array<double, drawings::zones> thermostat_offset_K;  ///< Floor-area mean zero.
  double wall_u_W_m2K;
  double roof_u_W_m2K;
  double ground_u_W_m2K;
  double window_u_W_m2K;
  double window_shgc;
  double blind_transmittance;  ///< Of a drawn blind.
  double leakage_cm2_m2;
  double ground_C;
  double occupied_from_h;
  double occupied_to_h;
  bool saturday_operation;  ///< Office air handlers run 8-14 h on Saturdays.
  std::array<double, drawings::air_handlers> outdoor_m3_s;  ///< Sums to `outdoor_airflow_m3_s`.
  std::array<double, drawings::air_handlers> supply_C;
  double office_supply_reset_K;
  double laboratory_night_share;
  double box_minimum_scale;
  double fan_scale;
  double fan_exponent;
  double coil_scale;
  double lighting_scale;
  double office_plugs_scale;
  double laboratory_plugs_scale;
  double equipment_plugs_scale;
  double zone_heat_share;
  double exterior_kW;
  double hot_water_m3_day;
  double chilled_water_loss_share;   ///< Of the load.
  double chilled_water_standing_kW;  ///< Heat that pipes pick up whatever the load.
  double steam_efficiency;           ///< Converter.
  double steam_standing_kW;          ///< Traps and pipes.
  double pump_kW;
};

[[nodiscard]] Truth draw_truth(std::uint64_t seed);

}  // namespace recald::simulators
