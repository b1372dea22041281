#include "simulators/climate/normals.hpp"

namespace recald::simulators {
namespace {

// Temperature, daily range, precipitation, wet days, snowfall, degree days: NOAA U.S. Climate
// Normals 1991-2020 of the airport, converted from degF and inches; degree days to the nearest 10.
// Dew point: NOAA local climatological data 1961-1990, moved with the mean temperature to 1991-2020
// (same dew-point depression); Phoenix unmoved, its air has not become moister.
// Wind: NOAA Comparative Climatic Data, records to 2000 and later.
// Global radiation: the typical years TMY3 (NREL 2008) of Atlanta, Phoenix and Seattle; NREL Solar
// Radiation Data Manual (Marion, Wilcox 1994) for Baltimore and Minneapolis.
// Design temperatures and extremes: ASHRAE Handbook Fundamentals, 2009 (Phoenix, Baltimore,
// Minneapolis), 2013 (Seattle), 2017 (Atlanta).
// Compiled by hand, to judge the generator; take exact values from the sources.

constexpr City kAtlanta{"Atlanta", {33.63, -84.44, 308.0}, "America/New_York"};
constexpr City kPhoenix{"Phoenix", {33.45, -111.98, 337.0}, "America/Phoenix"};
constexpr City kBaltimore{"Baltimore", {39.17, -76.68, 45.0}, "America/New_York"};
constexpr City kMinneapolis{"Minneapolis", {44.88, -93.23, 255.0}, "America/Chicago"};
constexpr City kSeattle{"Seattle", {47.46, -122.31, 122.0}, "America/Los_Angeles"};

constexpr Normals kAtlantaNormals{
    .dry_bulb_C = {7.1, 9.2, 13.1, 17.3, 21.8, 25.5, 27.2, 26.8, 23.8, 18.2, 12.3, 8.5},
    .daily_range_K = {10.2, 10.7, 11.4, 11.8, 11.0, 10.3, 10.2, 9.8, 10.0, 10.8, 11.1, 9.9},
    .dew_point_C = {0.7, 1.8, 5.1, 8.7, 14.7, 19.1, 21.4, 21.4, 18.2, 11.9, 5.9, 2.1},
    .wind_m_s = {4.6, 4.7, 4.9, 4.5, 3.9, 3.6, 3.4, 3.3, 3.6, 3.8, 4.1, 4.4},
    .global_kWh_m2_day = {2.78, 3.33, 4.65, 5.74, 6.32, 6.73, 6.31, 5.82, 4.36, 3.84, 2.95, 2.53},
    .precipitation_mm = {117, 116, 119, 97, 90, 115, 121, 109, 97, 83, 101, 116},
    .wet_days = 113,
    .snowfall_mm = 6,
    .heating_K_days = 1440,
    .cooling_K_days = 1140,
    .heating_design_C = -5.6,
    .cooling_design_C = 34.4,
    .annual_minimum_C = -9.5,
    .annual_maximum_C = 35.9,
};

constexpr Normals kPhoenixNormals{
    .dry_bulb_C = {13.8, 15.6, 19.1, 22.9, 27.8, 33.0, 35.3, 34.7, 31.8, 24.9, 18.2, 13.2},
    .daily_range_K = {12.0, 12.1, 13.1, 13.7, 13.9, 14.2, 12.2, 11.9, 12.4, 13.7, 13.1, 11.6},
    .dew_point_C = {0.0, 0.2, 0.6, -0.1, 1.2, 3.9, 13.1, 14.5, 11.3, 6.1, 2.1, 0.6},
    .wind_m_s = {2.4, 2.6, 3.0, 3.1, 3.2, 3.0, 3.2, 3.0, 2.8, 2.6, 2.4, 2.3},
    .global_kWh_m2_day = {3.29, 4.16, 5.34, 7.09, 7.84, 8.32, 7.62, 7.13, 6.34, 4.82, 3.77, 3.07},
    .precipitation_mm = {22, 22, 21, 6, 3, 1, 23, 24, 14, 14, 14, 19},
    .wet_days = 33,
    .snowfall_mm = 0,
    .heating_K_days = 500,
    .cooling_K_days = 2640,
    .heating_design_C = 3.7,
    .cooling_design_C = 43.4,
    .annual_minimum_C = 1.3,
    .annual_maximum_C = 45.8,
};

constexpr Normals kBaltimoreNormals{
    .dry_bulb_C = {1.3, 2.6, 6.8, 12.8, 18.0, 23.1, 25.7, 24.6, 20.7, 14.1, 8.3, 3.7},
    .daily_range_K = {9.9, 10.8, 11.6, 12.7, 12.3, 12.1, 11.7, 11.5, 11.6, 12.1, 11.6, 9.9},
    .dew_point_C = {-5.3, -4.8, -1.6, 4.0, 10.8, 16.2, 18.8, 18.1, 14.6, 7.9, 1.8, -2.7},
    .wind_m_s = {4.3, 4.5, 4.8, 4.6, 4.1, 3.7, 3.5, 3.4, 3.5, 3.8, 4.1, 4.1},
    .global_kWh_m2_day = {2.1, 2.9, 3.9, 4.9, 5.6, 6.2, 6.0, 5.3, 4.3, 3.3, 2.3, 1.8},
    .precipitation_mm = {78, 74, 102, 86, 98, 101, 114, 104, 113, 100, 80, 94},
    .wet_days = 116,
    .snowfall_mm = 49,
    .heating_K_days = 2470,
    .cooling_K_days = 730,
    .heating_design_C = -10.6,
    .cooling_design_C = 34.4,
    .annual_minimum_C = -14.9,
    .annual_maximum_C = 36.7,
};

constexpr Normals kMinneapolisNormals{
    .dry_bulb_C = {-8.8, -6.3, 0.7, 8.4, 15.3, 20.9, 23.5, 22.1, 17.5, 9.7, 1.6, -5.6},
    .daily_range_K = {8.2, 8.8, 9.3, 10.6, 10.7, 10.3, 10.1, 9.9, 10.4, 9.6, 7.9, 7.6},
    .dew_point_C = {-13.1, -11.0, -5.0, 0.2, 6.9, 13.4, 16.0, 15.3, 11.6, 3.7, -3.0, -9.3},
    .wind_m_s = {4.7, 4.6, 5.1, 5.4, 5.0, 4.6, 4.2, 4.1, 4.5, 4.7, 4.9, 4.6},
    .global_kWh_m2_day = {1.8, 2.7, 3.8, 4.8, 5.7, 6.2, 6.3, 5.3, 4.0, 2.7, 1.7, 1.4},
    .precipitation_mm = {23, 22, 43, 74, 99, 116, 103, 110, 77, 66, 41, 30},
    .wet_days = 119,
    .snowfall_mm = 130,
    .heating_K_days = 4120,
    .cooling_K_days = 430,
    .heating_design_C = -24.0,
    .cooling_design_C = 32.7,
    .annual_minimum_C = -27.5,
    .annual_maximum_C = 35.2,
};

constexpr Normals kSeattleNormals{
    .dry_bulb_C = {6.0, 6.7, 8.4, 10.7, 14.2, 16.7, 19.5, 19.7, 17.0, 12.1, 8.2, 5.6},
    .daily_range_K = {5.7, 7.0, 7.9, 8.9, 9.7, 9.9, 11.3, 11.2, 10.1, 7.5, 6.0, 5.5},
    .dew_point_C = {2.1, 2.0, 3.2, 4.9, 7.7, 9.6, 11.8, 12.6, 11.2, 7.8, 4.6, 2.1},
    .wind_m_s = {4.3, 4.2, 4.2, 4.2, 3.9, 3.8, 3.7, 3.5, 3.6, 3.8, 4.1, 4.2},
    .global_kWh_m2_day = {1.01, 1.79, 2.82, 4.34, 5.47, 5.93, 6.23, 5.04, 3.68, 2.27, 1.17, 0.89},
    .precipitation_mm = {147, 96, 106, 81, 48, 37, 15, 25, 41, 99, 160, 145},
    .wet_days = 156,
    .snowfall_mm = 16,
    .heating_K_days = 2450,
    .cooling_K_days = 140,
    .heating_design_C = -3.8,
    .cooling_design_C = 29.6,
    .annual_minimum_C = -6.0,
    .annual_maximum_C = 34.0,
};

constexpr std::array<City, 5> kCities{kAtlanta, kPhoenix, kBaltimore, kMinneapolis, kSeattle};
constexpr std::array<Normals, 5> kNormals{kAtlantaNormals, kPhoenixNormals, kBaltimoreNormals,
                                          kMinneapolisNormals, kSeattleNormals};

}  // namespace

const City& comparable_city(ClimateKind kind) { return kCities[static_cast<std::size_t>(kind)]; }

const Normals& normals_of(ClimateKind kind) { return kNormals[static_cast<std::size_t>(kind)]; }

double annual_mean(const Monthly& monthly) {
  constexpr Monthly days{31, 28.25, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  double sum = 0.0;
  for (std::size_t month = 0; month < 12; ++month) sum += monthly[month] * days[month];
  return sum / 365.25;
}

}  // namespace recald::simulators
