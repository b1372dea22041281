#include "simulators/building/truth.hpp"

#include <algorithm>

#include "simulators/chance/chance.hpp"

namespace recald::simulators {
namespace {

/// Below 21 degC the boxes cannot hold the set-point in summer, above 27.2 degC nobody would stay:
/// draws beyond are drawn again. The band keeps 93 % of the prior.
double draw_cooling_setpoint_C(Rng& rng) {
  const Triangular prior{20.0, drawings::cooling_setpoint_C, 27.8};
  for (;;) {
    const double drawn_C = prior.draw(rng);
    if (drawn_C >= 21.2 && drawn_C <= 27.0) return drawn_C;
  }
}

void draw_air_handlers(Truth& truth, Rng& rng) {
  using namespace drawings;
  const double built_share = truth.outdoor_airflow_m3_s / outdoor_air_m3_s;
  double sum_m3_s = 0.0;
  for (std::size_t i = 0; i < air_handlers; ++i) {
    const double design_m3_s = i % 2 == 0 ? office_outdoor_m3_s : laboratory_outdoor_m3_s;
    truth.outdoor_m3_s[i] = draw_around(rng, design_m3_s * built_share, 0.12);
    sum_m3_s += truth.outdoor_m3_s[i];
    truth.supply_C[i] = drawings::supply_C + Triangular{-0.9, 0.0, 1.0}.draw(rng);
  }
  for (double& flow_m3_s : truth.outdoor_m3_s) flow_m3_s *= truth.outdoor_airflow_m3_s / sum_m3_s;
}

void draw_thermostats(Truth& truth, Rng& rng) {
  using namespace drawings;
  double mean_K = 0.0;
  for (std::size_t zone = 0; zone < zones; ++zone) {
    truth.thermostat_offset_K[zone] = 0.45 * rng.normal();
    mean_K += truth.thermostat_offset_K[zone] * zone_area_m2[zone % zones_per_storey];
  }
  mean_K /= floor_area_m2;
  for (double& offset_K : truth.thermostat_offset_K) offset_K -= mean_K;
}

}  // namespace

Truth draw_truth(std::uint64_t seed) {
  using namespace drawings;
  Rng rng = stream_of(seed, Stream::building);
  Truth truth{};
  truth.occupancy_density_person_m2 =
      Triangular{0.0, occupancy_person_m2, 2.0 * occupancy_person_m2}.draw(rng);
  truth.outdoor_airflow_m3_s =
      Triangular{0.3 * outdoor_air_m3_s, outdoor_air_m3_s, 1.2 * outdoor_air_m3_s}.draw(rng);
  truth.cooling_setpoint_C = draw_cooling_setpoint_C(rng);

  truth.thermostat_band_K = Triangular{1.0, 1.4, 2.0}.draw(rng);
  // Controllers refuse overlapping bands: the heating set-point gives way to a low cooling one.
  truth.heating_setpoint_C = std::min(Triangular{20.3, heating_setpoint_C, 21.9}.draw(rng),
                                      truth.cooling_setpoint_C - truth.thermostat_band_K - 0.3);
  truth.office_night_heating_C = Triangular{15.5, office_night_heating_C, 18.0}.draw(rng);
  truth.office_night_cooling_C = Triangular{28.0, office_night_cooling_C, 30.0}.draw(rng);
  draw_thermostats(truth, rng);

  truth.wall_u_W_m2K = draw_around(rng, wall_u_W_m2K, 0.15);
  truth.roof_u_W_m2K = draw_around(rng, roof_u_W_m2K, 0.15);
  truth.ground_u_W_m2K = draw_around(rng, ground_u_W_m2K, 0.15);
  truth.window_u_W_m2K = draw_around(rng, window_u_W_m2K, 0.15);
  truth.window_shgc = draw_around(rng, window_shgc, 0.15);
  truth.blind_transmittance = Triangular{0.35, 0.5, 0.65}.draw(rng);
  truth.leakage_cm2_m2 = Triangular{0.5, leakage_cm2_m2, 2.6}.draw(rng);
  truth.ground_C = Triangular{16.5, ground_C, 19.5}.draw(rng);

  truth.occupied_from_h = Triangular{5.25, occupied_from_h, 6.75}.draw(rng);
  truth.occupied_to_h = Triangular{19.0, occupied_to_h, 21.0}.draw(rng);
  truth.saturday_operation = rng.uniform() < 0.5;
  draw_air_handlers(truth, rng);
  truth.office_supply_reset_K = Triangular{0.0, 1.5, 3.0}.draw(rng);
  truth.laboratory_night_share = Triangular{0.82, laboratory_night_share, 0.97}.draw(rng);
  truth.box_minimum_scale = draw_around(rng, 1.0, 0.12);
  truth.fan_scale = draw_around(rng, 1.0, 0.10);
  truth.fan_exponent = Triangular{1.9, 2.3, 2.8}.draw(rng);
  truth.coil_scale = draw_around(rng, 1.0, 0.08);

  truth.lighting_scale = draw_around(rng, 1.0, 0.10);
  truth.office_plugs_scale = draw_around(rng, 1.0, 0.15);
  truth.laboratory_plugs_scale = draw_around(rng, 1.0, 0.15);
  truth.equipment_plugs_scale = draw_around(rng, 1.0, 0.12);
  truth.zone_heat_share = Triangular{0.83, zone_heat_share, 0.97}.draw(rng);
  truth.exterior_kW = draw_around(rng, exterior_kW, 0.10);
  truth.hot_water_m3_day = draw_around(rng, hot_water_m3_day, 0.20);
  truth.chilled_water_loss_share = Triangular{0.01, 0.02, 0.03}.draw(rng);
  truth.chilled_water_standing_kW = Triangular{2.0, 4.0, 7.0}.draw(rng);
  truth.steam_efficiency = Triangular{0.95, converter_efficiency, 0.98}.draw(rng);
  truth.steam_standing_kW = Triangular{4.0, 8.0, 13.0}.draw(rng);
  truth.pump_kW = draw_around(rng, pump_kW, 0.12);
  return truth;
}

}  // namespace recald::simulators
