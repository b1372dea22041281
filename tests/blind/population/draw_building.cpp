#include "tests/blind/population/draw_building.hpp"

#include <algorithm>
#include <cmath>

namespace recald::blind {
namespace {

using namespace simulators;

template <class T, std::size_t N>
T draw_one(const std::array<T, N>& values, const std::array<double, N>& weights, Rng& rng) {
  double sum = 0.0;
  for (const double weight : weights) sum += weight;
  double left = rng.uniform() * sum;
  for (std::size_t i = 0; i + 1 < N; ++i) {
    if (left < weights[i]) return values[i];
    left -= weights[i];
  }
  return values[N - 1];
}

double rounded(double value, int digits) {
  const double scale = std::pow(10.0, digits - 1 - std::floor(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

struct Demands {
  bool chiller = false;
  bool economiser = false;
  bool heat_meter = false;
  bool timetable = false;
  bool skylight = false;
  std::optional<HeatingPlant> heating;
};

Demands demands_of(const std::vector<EffectNeeds>& needs) {
  Demands all;
  for (const EffectNeeds& one : needs) {
    all.chiller |= one.own_chiller;
    all.economiser |= one.economiser;
    all.heat_meter |= one.heat_meter;
    all.timetable |= one.timetable;
    all.skylight |= one.skylight;
    if (one.heat_pump) all.heating = HeatingPlant::heat_pump;
    if (one.fuel) all.heating = HeatingPlant::boiler;
  }
  return all;
}

HeatingPlant draw_heating(const Demands& demands, Rng& rng) {
  const auto drawn =
      draw_one<HeatingPlant, 4>({HeatingPlant::district_steam, HeatingPlant::district_water,
                                 HeatingPlant::boiler, HeatingPlant::heat_pump},
                                {0.2, 0.32, 0.36, 0.12}, rng);
  if (demands.heating) return *demands.heating;
  const bool unmetered = drawn == HeatingPlant::heat_pump && demands.heat_meter;
  return unmetered ? HeatingPlant::district_water : drawn;
}

}  // namespace

Drawings draw_building(const std::vector<EffectNeeds>& needs, Rng& rng) {
  const Demands demands = demands_of(needs);
  Brief brief;
  // Every draw is made whatever is demanded: what is hidden must not shift the building's chance.
  brief.use = draw_one<Use, 3>({Use::office, Use::laboratory, Use::school}, {0.5, 0.25, 0.25}, rng);
  brief.climate = kClimateKinds[rng.below(kClimateKinds.size())];
  brief.storeys = brief.use == Use::school ? 1 + rng.below(3) : 1 + rng.below(9);
  brief.length_m = std::round(rng.uniform(34.0, 90.0));
  brief.width_m = std::round(rng.uniform(18.0, 44.0));
  brief.window_share = rounded(rng.uniform(0.18, 0.55), 2);
  brief.heavy = rng.uniform() < 0.6;
  const double skylight_share = rounded(rng.uniform(0.06, 0.18), 2);
  const bool has_skylight = rng.uniform() < 0.15;
  const bool own_chiller = rng.uniform() < 0.4;
  brief.heating = draw_heating(demands, rng);
  if (demands.economiser && brief.climate == ClimateKind::hot_humid) {
    brief.climate = ClimateKind::mixed;
  }
  if (demands.timetable && brief.use == Use::laboratory) brief.use = Use::office;
  brief.skylight_share = has_skylight || demands.skylight ? skylight_share : 0.0;
  brief.cooling = own_chiller || demands.chiller ? CoolingPlant::chiller : CoolingPlant::district;
  return draw_up(brief);
}

Drawings misremembered(Drawings drawings, Rng& rng) {
  const auto off_by = [&](double& value, double spread) {
    value = rounded(value * (1.0 + spread * (rng.uniform() + rng.uniform() - 1.0)), 2);
  };
  off_by(drawings.wall_u_W_m2K, 0.3);
  off_by(drawings.roof_u_W_m2K, 0.3);
  off_by(drawings.window_u_W_m2K, 0.2);
  off_by(drawings.ground_u_W_m2K, 0.4);
  off_by(drawings.window_shgc, 0.2);
  off_by(drawings.leakage_cm2_m2, 0.5);
  for (RoomUse* rooms :
       {&drawings.perimeter_rooms, &drawings.core_rooms, &drawings.special_rooms}) {
    off_by(rooms->lighting_W_m2, 0.15);
    off_by(rooms->plugs_W_m2, 0.25);
  }
  off_by(drawings.perimeter_air.fan_kW, 0.15);
  off_by(drawings.core_air.fan_kW, 0.15);
  off_by(drawings.pump_kW, 0.2);
  off_by(drawings.exterior_kW, 0.3);
  off_by(drawings.hot_water_m3_day, 0.4);
  off_by(drawings.heating_efficiency, 0.03);
  drawings.heating_efficiency = std::min(drawings.heating_efficiency, 0.99);
  off_by(drawings.chiller_cop, 0.12);
  return drawings;
}

}  // namespace recald::blind
