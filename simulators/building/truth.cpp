#include "simulators/building/truth.hpp"

#include <algorithm>

#include "simulators/chance/chance.hpp"

namespace recald::simulators {
namespace {

/// Below 21 degC the boxes cannot hold the set-point in summer; above 27.2 degC nobody would stay.
/// Draws outside this band are repeated. The band keeps 93 % of the prior.
double draw_cooling_setpoint_C(const Drawings& drawn, Rng& rng) {
  const Triangular prior{20.0, drawn.cooling_setpoint_C, 27.8};
  for (;;) {
    const double built_C = prior.draw(rng);
    if (built_C >= 21.2 && built_C <= 27.0) return built_C;
  }
}

void draw_air_handlers(Truth& truth, Rng& rng) {
  const Drawings& drawn = truth.drawings;
  const double built_share = truth.outdoor_airflow_m3_s / drawn.outdoor_air_m3_s();
  double sum_m3_s = 0.0;
  for (std::size_t i = 0; i < drawn.air_handlers(); ++i) {
    const AirHandlerPlate& plate = i % 2 == 0 ? drawn.perimeter_air : drawn.core_air;
    truth.outdoor_m3_s.push_back(draw_around(rng, plate.outdoor_m3_s * built_share, 0.12));
    sum_m3_s += drawn.storey_weight(i / 2) * truth.outdoor_m3_s.back();
    truth.supply_C.push_back(drawn.supply_C + Triangular{-0.9, 0.0, 1.0}.draw(rng));
  }
  for (double& flow_m3_s : truth.outdoor_m3_s) flow_m3_s *= truth.outdoor_airflow_m3_s / sum_m3_s;
}

void draw_thermostats(Truth& truth, Rng& rng) {
  const Drawings& drawn = truth.drawings;
  double mean_K = 0.0;
  for (std::size_t zone = 0; zone < drawn.zones(); ++zone) {
    truth.thermostat_offset_K.push_back(0.45 * rng.normal());
    mean_K += drawn.storey_weight(zone / kZonesPerStorey) * truth.thermostat_offset_K.back() *
              drawn.zone_m2(zone % kZonesPerStorey);
  }
  mean_K /= drawn.floor_area_m2();
  for (double& offset_K : truth.thermostat_offset_K) offset_K -= mean_K;
}

void draw_shared(Truth& truth, Rng& rng) {
  const Drawings& drawn = truth.drawings;
  truth.occupancy_density_person_m2 =
      Triangular{0.0, drawn.occupancy_person_m2, 2.0 * drawn.occupancy_person_m2}.draw(rng);
  const double outdoor_m3_s = drawn.outdoor_air_m3_s();
  truth.outdoor_airflow_m3_s =
      Triangular{0.3 * outdoor_m3_s, outdoor_m3_s, 1.2 * outdoor_m3_s}.draw(rng);
  truth.cooling_setpoint_C = draw_cooling_setpoint_C(drawn, rng);
}

void draw_setpoints(Truth& truth, Rng& rng) {
  const Drawings& drawn = truth.drawings;
  const auto between = [&](double nominal, double below, double above) {
    return Triangular{nominal - below, nominal, nominal + above}.draw(rng);
  };
  truth.thermostat_band_K = Triangular{1.0, 1.4, 2.0}.draw(rng);
  // Controllers refuse overlapping bands, so a low cooling set-point pushes the
  // heating set-point down.
  const Triangular heating{drawn.heating_setpoint_min_C, drawn.heating_setpoint_C,
                           drawn.heating_setpoint_max_C};
  truth.heating_setpoint_C =
      std::min(heating.draw(rng), truth.cooling_setpoint_C - truth.thermostat_band_K - 0.3);
  truth.night_heating_C = between(drawn.night_heating_C, 1.5, 1.0);
  truth.night_cooling_C = between(drawn.night_cooling_C, 1.0, 1.0);
  draw_thermostats(truth, rng);
}

void draw_envelope(Truth& truth, Rng& rng) {
  const Drawings& drawn = truth.drawings;
  truth.wall_u_W_m2K = draw_around(rng, drawn.wall_u_W_m2K, 0.15);
  truth.roof_u_W_m2K = draw_around(rng, drawn.roof_u_W_m2K, 0.15);
  truth.ground_u_W_m2K = draw_around(rng, drawn.ground_u_W_m2K, 0.15);
  truth.window_u_W_m2K = draw_around(rng, drawn.window_u_W_m2K, 0.15);
  truth.window_shgc = draw_around(rng, drawn.window_shgc, 0.15);
  truth.blind_transmittance = Triangular{0.35, 0.5, 0.65}.draw(rng);
  const double leakage = drawn.leakage_cm2_m2 / 1.3;
  truth.leakage_cm2_m2 = Triangular{0.5 * leakage, drawn.leakage_cm2_m2, 2.6 * leakage}.draw(rng);
  truth.ground_C = Triangular{drawn.ground_C - 1.5, drawn.ground_C, drawn.ground_C + 1.5}.draw(rng);
}

void draw_air_system(Truth& truth, Rng& rng) {
  const Drawings& drawn = truth.drawings;
  truth.occupied_from_h =
      Triangular{drawn.occupied_from_h - 0.75, drawn.occupied_from_h, drawn.occupied_from_h + 0.75}
          .draw(rng);
  truth.occupied_to_h =
      Triangular{drawn.occupied_to_h - 1.0, drawn.occupied_to_h, drawn.occupied_to_h + 1.0}.draw(
          rng);
  const bool saturdays = rng.uniform() < 0.5;
  truth.saturday_operation = drawn.saturday_operation.value_or(saturdays);
  draw_air_handlers(truth, rng);
  truth.supply_reset_K = Triangular{0.0, 1.5, 3.0}.draw(rng);
  const double night = drawn.core_night_share / 0.9;
  const double night_share =
      Triangular{0.82 * night, drawn.core_night_share, 0.97 * night}.draw(rng);
  truth.core_night_share = drawn.core_night_share < 1.0 ? night_share : 1.0;  // no set-back
  truth.box_minimum_scale = draw_around(rng, 1.0, 0.12);
  truth.fan_scale = draw_around(rng, 1.0, 0.10);
  truth.fan_exponent = Triangular{1.9, 2.3, 2.8}.draw(rng);
  truth.coil_scale = draw_around(rng, 1.0, 0.08);
}

void draw_loads(Truth& truth, Rng& rng) {
  const Drawings& drawn = truth.drawings;
  truth.lighting_scale = draw_around(rng, 1.0, 0.10);
  truth.perimeter_plugs_scale = draw_around(rng, 1.0, 0.15);
  truth.core_plugs_scale = draw_around(rng, 1.0, 0.15);
  truth.special_plugs_scale = draw_around(rng, 1.0, 0.12);
  const double hoods = drawn.zone_heat_share - 0.9;  // below 0 if hoods remove more
  truth.zone_heat_share = Triangular{0.83 + hoods, drawn.zone_heat_share, 0.97 + hoods}.draw(rng);
  truth.exterior_kW = draw_around(rng, drawn.exterior_kW, 0.10);
}

/// Scatters around the drawings' value; without one, it follows the size of the plant.
double draw_standing_kW(const std::optional<double>& drawn_kW, double size, const Triangular& usual,
                        Rng& rng) {
  if (drawn_kW) return draw_around(rng, *drawn_kW, 0.25);
  return size * usual.draw(rng);
}

void draw_plant(Truth& truth, Rng& rng) {
  const Drawings& drawn = truth.drawings;
  truth.hot_water_m3_day = draw_around(rng, drawn.hot_water_m3_day, 0.20);
  truth.chilled_water_loss_share = Triangular{0.01, 0.02, 0.03}.draw(rng);
  truth.chilled_water_standing_kW = draw_standing_kW(
      drawn.chilled_water_standing_kW, drawn.chilled_water_design_kW / 900.0, {2.0, 4.0, 7.0}, rng);
  const double efficiency = drawn.heating_efficiency / 0.97;
  truth.heating_efficiency =
      Triangular{0.95 * efficiency, drawn.heating_efficiency, 0.98 * efficiency}.draw(rng);
  truth.heating_standing_kW = draw_standing_kW(
      drawn.heating_standing_kW, drawn.heating_design_kW / 700.0, {4.0, 8.0, 13.0}, rng);
  truth.pump_kW = draw_around(rng, drawn.pump_kW, 0.12);
  truth.chiller_cop_scale = draw_around(rng, 1.0, 0.10);
  truth.heat_pump_cop_scale = draw_around(rng, 1.0, 0.10);
}

}  // namespace

Truth draw_truth(const Drawings& drawings, std::uint64_t seed) {
  Rng rng = stream_of(seed, Stream::building);
  Truth truth{};
  truth.drawings = drawings;
  // The order of draws is part of what a seed means: new ones come last.
  draw_shared(truth, rng);
  draw_setpoints(truth, rng);
  draw_envelope(truth, rng);
  draw_air_system(truth, rng);
  draw_loads(truth, rng);
  draw_plant(truth, rng);
  return truth;
}

}  // namespace recald::simulators
