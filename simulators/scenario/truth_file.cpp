#include <algorithm>
#include <nlohmann/json.hpp>

#include "simulators/scenario/scenario_files.hpp"

namespace recald::simulators {
namespace {

using Json = nlohmann::ordered_json;

Json shared_parameters(const Truth& truth) {
  return {
      {"occupancy_density",
       {{"value", truth.occupancy_density_person_m2},
        {"unit", "person/m2"},
        {"note",
         "People assigned to the building per floor area. Comparable to a model in which "
         "density times the site file's hourly share gives people present; the real share "
         "differs a little by season and day."}}},
      {"outdoor_airflow",
       {{"value", truth.outdoor_airflow_m3_s},
        {"unit", "m3/s"},
        {"note",
         "Sum of the air handlers' outdoor-air set-points while all ventilate. "
         "Comparable as the occupied flow; at night the offices' part is off and the "
         "laboratories' is set back by a share that the site file knows approximately."}}},
      {"cooling_setpoint",
       {{"value", truth.cooling_setpoint_C},
        {"unit", "degC"},
        {"note",
         "Floor-area mean of the thermostats' cooling set-points in occupied hours, centre "
         "of the throttling band, felt as operative temperature. Comparable with "
         "reservations: zones that need no cooling float below it, laboratories hold it "
         "at night too."}}},
  };
}

Json other_parameters(const Truth& truth) {
  return {
      {"heating_setpoint_C", truth.heating_setpoint_C},
      {"night_heating_C", truth.night_heating_C},
      {"night_cooling_C", truth.night_cooling_C},
      {"thermostat_band_K", truth.thermostat_band_K},
      {"thermostat_offset_K", truth.thermostat_offset_K},
      {"wall_u_W_m2K", truth.wall_u_W_m2K},
      {"roof_u_W_m2K", truth.roof_u_W_m2K},
      {"ground_u_W_m2K", truth.ground_u_W_m2K},
      {"window_u_W_m2K", truth.window_u_W_m2K},
      {"window_shgc", truth.window_shgc},
      {"blind_transmittance", truth.blind_transmittance},
      {"leakage_cm2_m2", truth.leakage_cm2_m2},
      {"ground_C", truth.ground_C},
      {"occupied_from_h", truth.occupied_from_h},
      {"occupied_to_h", truth.occupied_to_h},
      {"saturday_operation", truth.saturday_operation},
      {"air_handler_outdoor_m3_s", truth.outdoor_m3_s},
      {"air_handler_supply_C", truth.supply_C},
      {"supply_reset_K", truth.supply_reset_K},
      {"core_night_share", truth.core_night_share},
      {"box_minimum_scale", truth.box_minimum_scale},
      {"fan_scale", truth.fan_scale},
      {"fan_exponent", truth.fan_exponent},
      {"coil_scale", truth.coil_scale},
      {"lighting_scale", truth.lighting_scale},
      {"perimeter_plugs_scale", truth.perimeter_plugs_scale},
      {"core_plugs_scale", truth.core_plugs_scale},
      {"special_plugs_scale", truth.special_plugs_scale},
      {"zone_heat_share", truth.zone_heat_share},
      {"exterior_kW", truth.exterior_kW},
      {"hot_water_m3_day", truth.hot_water_m3_day},
      {"chilled_water_loss_share", truth.chilled_water_loss_share},
      {"chilled_water_standing_kW", truth.chilled_water_standing_kW},
      {"heating_efficiency", truth.heating_efficiency},
      {"heating_standing_kW", truth.heating_standing_kW},
      {"pump_kW", truth.pump_kW},
      {"chiller_cop_scale", truth.chiller_cop_scale},
      {"heat_pump_cop_scale", truth.heat_pump_cop_scale},
  };
}

Json fault_list(const Recording& recording, const std::vector<Fault>& faults) {
  Json list = Json::array();
  for (const Fault& fault : faults) {
    list.push_back({{"kind", to_string(fault.kind)},
                    {"from", metering::to_string(recording.start_of(fault.first))},
                    {"to", metering::to_string(recording.start_of(fault.first + fault.count))},
                    {"readings", fault.count}});
  }
  return list;
}

Json effect_list(const Scenario& scenario) {
  Json list = Json::array();
  const auto date = [](const std::optional<metering::Day>& day) {
    return day ? Json(metering::to_string(*day)) : Json(nullptr);
  };
  for (const HiddenChoice& choice : scenario.effects) {
    list.push_back({{"effect", choice.kind->id},
                    {"class", to_string(choice.kind->group)},
                    {"strength", choice.strength},
                    {"unit", choice.kind->strength.unit},
                    {"from", date(choice.from)},
                    {"to", date(choice.to)}});
  }
  return list;
}

double lost_share(const MeterFeed& feed) {
  std::size_t lost = 0;
  for (const Fault& fault : feed.faults) lost += fault.count;
  return static_cast<double>(lost) / static_cast<double>(feed.cells.size());
}

/// Clean figures of one meter: what a perfect meter without gaps would have measured.
Json monthly_figures(const Recording& recording, const metering::LocalCalendar& calendar,
                     Utility utility) {
  Json list = Json::array();
  std::size_t slot = 0;
  while (slot < recording.power.size()) {
    const metering::Month month = calendar.month_of(recording.start_of(slot));
    const metering::TimeSpan span = calendar.month_span(month);
    double energy_kWh = 0.0;
    double peak_kW = 0.0;
    metering::Instant peak_at = span.begin;
    for (; slot < recording.power.size() && recording.start_of(slot) < span.end; ++slot) {
      const double power_kW = recording.power[slot][utility];
      energy_kWh += 0.25 * power_kW;
      if (power_kW > peak_kW) {
        peak_kW = power_kW;
        peak_at = recording.start_of(slot);
      }
    }
    list.push_back({{"month", metering::to_string(month)},
                    {"daily_average_kWh", energy_kWh / metering::days_in(month)},
                    {"peak_kW", peak_kW},
                    {"peak_at", metering::to_string(peak_at)}});
  }
  return list;
}

Json meter_truth(const Recording& recording, const metering::LocalCalendar& calendar,
                 const MeterFeed& feed, double floor_m2) {
  const double years = static_cast<double>(recording.power.size()) / (365.25 * 96.0);
  double energy_kWh = 0.0;
  for (const UtilityPower& power : recording.power) {
    energy_kWh += 0.25 * power[feed.plate.utility];
  }
  return {{"gain", feed.gain},
          {"lost_share", lost_share(feed)},
          {"annual_kWh_m2", energy_kWh / years / floor_m2},
          {"monthly", monthly_figures(recording, calendar, feed.plate.utility)},
          {"faults", fault_list(recording, feed.faults)}};
}

}  // namespace

std::string truth_json(const Scenario& scenario, std::uint64_t seed, const Simulated& simulated,
                       const std::vector<MeterFeed>& feeds, const WeatherFeed& weather,
                       const metering::LocalCalendar& calendar) {
  const Truth& truth = simulated.building.truth();
  const Recording& recording = simulated.recording;
  const double floor_m2 = truth.drawings.floor_area_m2();
  Json meters = Json::object();
  for (const MeterFeed& feed : feeds) {
    if (feed.plate.id == neighbour_plate().id) continue;  // not part of this building
    meters[std::string(feed.plate.id)] = meter_truth(recording, calendar, feed, floor_m2);
  }
  const Json json = {
      {"seed", seed},
      {"start", scenario.period.start_year},
      {"years", scenario.period.years},
      {"floor_area_m2", floor_m2},
      {"parameters", shared_parameters(truth)},
      {"other_parameters", other_parameters(truth)},
      {"effects", effect_list(scenario)},
      {"weather_station",
       {{"dry_bulb_bias_K", weather.dry_bulb_bias_K},
        {"humidity_bias", weather.humidity_bias},
        {"pyranometer_gain", weather.pyranometer_gain},
        {"faults", fault_list(recording, weather.faults)}}},
      {"meters", meters},
  };
  return json.dump(1) + "\n";
}

}  // namespace recald::simulators
