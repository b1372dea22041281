#include "tests/blind/population/draw_building.hpp"

#include <algorithm>
#include <cmath>

#include "tests/blind/population/significant_digits.hpp"

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

struct Range {
  double least, most;

  double draw(Rng& rng) const { return rng.uniform(least, most); }
};

/// What stands in a country of buildings of one use; weights need not sum to 1. No heat pumps where
/// much warm water is drawn: a site file cannot tell that electricity heats it.
struct Stock {
  Use use;
  std::array<double, 2> storeys;
  Range length_m, width_m, window_share;
  double heavy_share;
  double skylit_share;
  std::array<double, 3> cooling;  ///< District, chiller, packaged.
  std::array<double, 4> heating;  ///< District steam, district water, boiler, heat pump.
};

constexpr auto kStocks = std::to_array<Stock>({
    {Use::laboratory, {1, 6}, {36, 80}, {24, 44}, {0.2, 0.5}, 0.8, 0.1, {6, 4, 0}, {4, 2, 4, 0}},
    {Use::office, {1, 9}, {34, 90}, {18, 44}, {0.2, 0.55}, 0.6, 0.1, {4, 4, 2}, {2, 3, 4, 1}},
    {Use::school, {1, 3}, {40, 90}, {20, 44}, {0.2, 0.45}, 0.7, 0.2, {4, 3, 3}, {1, 3, 5, 1}},
    {Use::shop, {1, 2}, {40, 110}, {28, 70}, {0.05, 0.2}, 0.4, 0.3, {2, 3, 5}, {0, 2, 6, 2}},
    {Use::hotel, {3, 12}, {36, 80}, {15, 22}, {0.2, 0.45}, 0.7, 0.0, {3, 5, 2}, {1, 3, 6, 0}},
    {Use::clinic, {1, 5}, {34, 70}, {24, 44}, {0.18, 0.4}, 0.7, 0.1, {4, 4, 2}, {2, 3, 5, 0}},
    {Use::warehouse, {1, 1}, {60, 150}, {36, 80}, {0.02, 0.06}, 0.3, 0.3, {0, 3, 7}, {0, 2, 7, 1}},
    {Use::restaurant, {1, 1}, {20, 42}, {14, 24}, {0.15, 0.4}, 0.5, 0.0, {1, 3, 6}, {0, 2, 8, 0}},
    {Use::gym, {1, 2}, {30, 60}, {22, 40}, {0.1, 0.3}, 0.4, 0.2, {2, 3, 5}, {0, 3, 7, 0}},
});

}  // namespace

Drawings draw_building_of(Use use, Rng& rng) {
  const Stock& stock = *std::ranges::find(kStocks, use, &Stock::use);
  Brief brief{.use = use};
  brief.climate = kClimateKinds[rng.below(kClimateKinds.size())];
  const auto [fewest, most] = stock.storeys;
  brief.storeys = static_cast<std::size_t>(std::floor(rng.uniform(fewest, most + 1.0)));
  brief.length_m = std::round(stock.length_m.draw(rng));
  brief.width_m = std::round(stock.width_m.draw(rng));
  brief.window_share = rounded(stock.window_share.draw(rng), 2);
  brief.heavy = rng.uniform() < stock.heavy_share;
  const double skylight_share = rounded(rng.uniform(0.03, 0.12), 2);
  if (rng.uniform() < stock.skylit_share) brief.skylight_share = skylight_share;
  brief.cooling = draw_one<CoolingPlant, 3>(
      {CoolingPlant::district, CoolingPlant::chiller, CoolingPlant::packaged}, stock.cooling, rng);
  brief.heating =
      draw_one<HeatingPlant, 4>({HeatingPlant::district_steam, HeatingPlant::district_water,
                                 HeatingPlant::boiler, HeatingPlant::heat_pump},
                                stock.heating, rng);
  brief.vintage = draw_one<Vintage, 3>({Vintage::of_1980s, Vintage::of_2000s, Vintage::of_2010s},
                                       {0.35, 0.40, 0.25}, rng);
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
