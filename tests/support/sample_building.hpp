/// A small VAV building, its place and two years of made-up weather, for tests of the models.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/model/building.hpp"
#include "core/model/drivers.hpp"
#include "core/weather/weather_series.hpp"

namespace recald::testing {

inline model::Building sample_building() {
  using model::Surface;
  using model::SurfaceKind;
  model::Building b;
  b.floor_area_m2 = 5000.0;
  b.storeys = 3;
  b.storey_height_m = 4.0;
  b.heat_capacity_J_m2K = 165e3;
  const auto wall = [](double azimuth_deg) {
    return Surface{.name = "wall",
                   .kind = SurfaceKind::wall,
                   .area_m2 = 400.0,
                   .u_W_m2K = 0.5,
                   .orientation = {azimuth_deg, 90.0}};
  };
  const auto window = [](double azimuth_deg) {
    return Surface{.name = "window",
                   .kind = SurfaceKind::window,
                   .area_m2 = 150.0,
                   .u_W_m2K = 2.5,
                   .orientation = {azimuth_deg, 90.0},
                   .shgc = 0.4,
                   .frame_fraction = 0.2,
                   .shading_factor = 0.9};
  };
  for (const double azimuth_deg : {0.0, 90.0, 180.0, 270.0}) {
    b.surfaces.push_back(wall(azimuth_deg));
    b.surfaces.push_back(window(azimuth_deg));
  }
  b.surfaces.push_back({.name = "roof",
                        .kind = SurfaceKind::roof,
                        .area_m2 = 1667.0,
                        .u_W_m2K = 0.3,
                        .orientation = {0.0, 0.0}});
  b.surfaces.push_back(
      {.name = "slab", .kind = SurfaceKind::ground, .area_m2 = 1667.0, .u_W_m2K = 0.2});
  b.use = {.occupancy_person_m2 = 0.05,
           .sensible_W_person = 75.0,
           .latent_W_person = 55.0,
           .lighting_W_m2 = 8.0,
           .plugs_W_m2 = 10.0,
           .exterior_kW = 3.0,
           .zone_heat_share = 0.9};
  for (int hour = 7; hour < 19; ++hour) {
    b.occupied_fraction.at(model::DayType::workday, hour) = 0.8;
  }
  b.leakage_cm2_m2 = 1.2;
  b.air = model::AirSystem{.outdoor_air_m3_s = 6.0,
                           .outdoor_air_unoccupied_fraction = 0.4,
                           .supply_flow_design_m3_s = 25.0,
                           .supply_flow_min_m3_s = 9.0,
                           .supply_temperature_C = 13.0,
                           .fan_design_kW = 35.0,
                           .pump_design_kW = 6.0};
  b.heating_loss_fraction = 0.05;
  b.heating_efficiency = 0.95;
  b.cooling_loss_fraction = 0.03;
  b.hot_water = {.volume_m3_day = 2.0};
  b.ground_temperature_C = 16.0;
  return b;
}

inline model::ElectricLoads sample_loads() {
  model::ElectricLoads loads;
  for (std::size_t i = 0; i < model::kDayTypes; ++i) {
    const auto day = static_cast<model::DayType>(i);
    for (int hour = 0; hour < 24; ++hour) {
      const bool working = day == model::DayType::workday && hour >= 7 && hour < 19;
      loads.lights_kW.at(day, hour) = working ? 35.0 : 5.0;
      loads.plugs_kW.at(day, hour) = working ? 45.0 : 20.0;
    }
  }
  return loads;
}

inline weather::Location sample_location() { return {33.65, -84.43, 300.0}; }

/// Seasons, days and a wave of fronts; smooth, hot and humid in summer, no chance in it.
inline weather::WeatherSeries sample_weather(metering::Instant begin, int hours) {
  weather::WeatherSeries series{begin, {}};
  const weather::Location location = sample_location();
  for (int i = 0; i < hours; ++i) {
    const metering::Instant t = begin + std::chrono::hours{i};
    const double year = 2.0 * std::numbers::pi * i / 8766.0;
    const double day = 2.0 * std::numbers::pi * (i % 24) / 24.0;
    const double front = 4.0 * std::sin(2.0 * std::numbers::pi * i / 137.0);
    const double sun =
        std::max(weather::sun_position(t + std::chrono::minutes{30}, location).cos_zenith, 0.0);
    series.hours.push_back(
        {.dry_bulb_C = 17.0 - 11.0 * std::cos(year) - 4.0 * std::cos(day - 1.5) + front,
         .rel_humidity_pct = 68.0 + 15.0 * std::cos(day - 1.5) - 2.0 * front,
         .wind_speed_m_s = 3.5 + 1.5 * std::sin(2.0 * std::numbers::pi * i / 61.0),
         .wind_dir_deg = std::fmod(40.0 + i * 1.7, 360.0),
         .ghi_W_m2 = 800.0 * sun * (0.75 + 0.06 * front / 4.0)});
  }
  return series;
}

inline std::vector<metering::Month> months_of_2021_22(int count = 24) {
  std::vector<metering::Month> months;
  metering::Month month = std::chrono::year{2021} / std::chrono::January;
  for (int i = 0; i < count; ++i, month = metering::next_month(month)) months.push_back(month);
  return months;
}

/// Drivers of the sample building over the first `months` months of 2021 and 2022.
inline model::Drivers sample_drivers(const model::Building& building, int months = 24) {
  const auto calendar = *metering::LocalCalendar::open("America/New_York");
  const auto begin = std::chrono::sys_days{std::chrono::year{2020} / 12 / 31};
  const auto weather = sample_weather(begin, 24 * 735);
  auto drivers = model::make_drivers(months_of_2021_22(months), calendar, {}, building,
                                     sample_loads(), sample_location(), weather);
  return std::move(*drivers);
}

}  // namespace recald::testing
