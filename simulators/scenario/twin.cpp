#include "simulators/scenario/twin.hpp"

#include <algorithm>
#include <cmath>

namespace recald::simulators {
namespace {

/// Replaces the wind by that of another year in the same climate.
void replace_wind(Recording& recording, const Drawings& drawings, std::uint64_t seed) {
  WeatherGenerator elsewhere(climate_of(drawings.climate, drawings.place), recording.begin,
                             stream_of(seed, Stream::decoys), kInterval);
  for (WeatherMean& mean : recording.weather) {
    const Outdoors outdoors = elsewhere.advance();
    mean.wind_speed_m_s = outdoors.wind_speed_m_s;
    mean.wind_from_deg = outdoors.wind_from_deg;
  }
}

/// A shop next door, with its own hours and cooling.
Recording neighbour_of(const Recording& recording, const metering::LocalCalendar& calendar,
                       std::uint64_t seed) {
  Recording neighbour{recording.begin, {}, {}};
  Rng rng = stream_of(seed, Stream::neighbour);
  Persistence trade(86'400.0, static_cast<double>(kInterval.count()), rng);
  for (std::size_t slot = 0; slot < recording.weather.size(); ++slot) {
    const metering::LocalTime local = calendar.local_time(recording.start_of(slot));
    const std::chrono::weekday weekday{std::chrono::sys_days{local.date}};
    const double hour = local.minute_of_day / 60.0;
    const bool open = weekday != std::chrono::Sunday && hour >= 8.5 && hour < 20.0;
    const double warm_K = std::max(0.0, recording.weather[slot].dry_bulb_C - 17.0);
    const double power_kW = 9.0 + (open ? 38.0 + 2.1 * warm_K : 0.5 * warm_K);
    neighbour.power.push_back({power_kW * (1.0 + 0.06 * trade.advance(rng)), 0.0, 0.0});
  }
  return neighbour;
}

}  // namespace

Result<Simulated> simulate(const Scenario& scenario, std::uint64_t seed,
                           const metering::LocalCalendar& calendar) {
  Building building(draw_truth(scenario.drawings, seed), scenario.step, seed,
                    make_effects(scenario, seed, calendar));
  auto recording = TRY(record(building, scenario.period, seed));
  return Simulated{std::move(building), std::move(recording)};
}

Scenario twin_of(Scenario scenario) {
  scenario.effects.clear();
  return scenario;
}

std::vector<std::vector<double>> footprint_kW(const Simulated& with, const Simulated& without,
                                              const metering::LocalCalendar& calendar) {
  std::vector<std::vector<double>> footprint;
  for (const MeterPlate& plate : plates_of(with.building.truth().drawings)) {
    std::vector<double> added_kW =
        metered_kW(with.recording, plate.utility, with.building.effects(), calendar);
    const std::vector<double> plain_kW =
        metered_kW(without.recording, plate.utility, without.building.effects(), calendar);
    for (std::size_t slot = 0; slot < added_kW.size(); ++slot) added_kW[slot] -= plain_kW[slot];
    footprint.push_back(std::move(added_kW));
  }
  return footprint;
}

Feeds read_feeds(const Scenario& scenario, std::uint64_t seed, const Simulated& simulated,
                 const metering::LocalCalendar& calendar) {
  const HiddenEffects& effects = simulated.building.effects();
  Feeds feeds;
  for (const MeterPlate& plate : plates_of(scenario.drawings)) {
    feeds.meters.push_back(
        read_meter(simulated.recording, plate, scenario.care, seed, effects, calendar));
  }
  if (has_decoy(scenario, Decoy::neighbour_meter)) {
    feeds.meters.push_back(read_meter(neighbour_of(simulated.recording, calendar, seed),
                                      neighbour_plate(), scenario.care, seed + 1, {}, calendar));
  }
  if (has_decoy(scenario, Decoy::wind_of_another_year)) {
    Recording windless = simulated.recording;
    replace_wind(windless, scenario.drawings, seed);
    feeds.weather = read_weather_station(windless, scenario.care, seed);
  } else {
    feeds.weather = read_weather_station(simulated.recording, scenario.care, seed);
  }
  return feeds;
}

}  // namespace recald::simulators
